/* What a debug build may stop at: compile the runtime with T3R_ASSERT(condition) defined. */
#ifndef T3R_ASSERTION_H
#define T3R_ASSERTION_H

#ifndef T3R_ASSERT
#define T3R_ASSERT(condition) ((void)0)
#endif

#endif
