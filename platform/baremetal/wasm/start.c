/* From the call of the module to main(): the painted stack. It holds variables whose address is taken; the engine keeps
 * the others. */
#include "semihost.h"
#include "stack.h"

int main(void);

__attribute__((export_name("run"))) void run(void);

void run(void)
{
    stack_paint();
    semihost_exit(main());
}
