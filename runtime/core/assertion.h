/* What a debug build may stop at: compile the runtime with these defined. */
#ifndef T3R_ASSERTION_H
#define T3R_ASSERTION_H

/* How the library is called */
#ifndef T3R_ASSERT
#define T3R_ASSERT(condition) ((void)0)
#endif

/* The bounds that its own arithmetic counts on: the option T3R_CHECK_FIXED stops at them. */
#ifndef T3R_BOUND
#define T3R_BOUND(condition) ((void)0)
#endif

#endif
