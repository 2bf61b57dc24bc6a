/* SPDX-License-Identifier: Apache-2.0 */
/* The text that refuses a program of other headers than the host library's. */
#include "host/program_check.h"
#include "test.h"

/* Features that both sides have, or lack, are not named. */
TEST(features_that_differ_are_named)
{
    const t3r_program program = {1, T3R_HAS_COMPARISON | T3R_HAS_BACKDROP, "0.2.0"};
    const t3r_program library = {2, T3R_HAS_COMPARISON | T3R_HAS_STEREO | T3R_HAS_STREAMS, "0.2.1"};
    char error[256];
    assert_false(t3r_program_fits(program, library, error, sizeof error));
    assert_string_equal(error,
                        "the program was compiled with other headers than its library's: of trim3r 0.2.0 without "
                        "stereo, streams, and the library is trim3r 0.2.1 without backdrop: compile it again");
}
