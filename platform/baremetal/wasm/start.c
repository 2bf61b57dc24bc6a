/* From the call of the module to main(): the painted stack. It holds what has an address; other variables lie where the
 * engine keeps them. */
#include "semihost.h"
#include "stack.h"

int main(void);

__attribute__((export_name("run"))) void run(void);

void run(void)
{
    stack_paint();
    semihost_exit(main());
}
