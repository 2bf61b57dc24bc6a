/* SPDX-License-Identifier: Apache-2.0 */
/* The remaining time of work that was partly done before. */
#include "cli/text/time_left.h"
#include "test.h"

#define EXACT 1e-9

TEST(by_the_rate_so_far)
{
    assert_float_equal(cli_time_left(0, 1, 4, 2), 6, EXACT);
    assert_float_equal(cli_time_left(0, 3, 4, 6), 2, EXACT);
    assert_float_equal(cli_time_left(0, 4, 4, 8), 0, EXACT);
}

TEST(what_was_there_took_no_time)
{
    assert_float_equal(cli_time_left(300, 310, 400, 20), 180, EXACT);
    assert_float_equal(cli_time_left(0, 310, 400, 20), 20.0 / 310 * 90, EXACT);
    assert_float_equal(cli_time_left(4, 4, 4, 1), 0, EXACT);
}

TEST(nothing_is_known_before_the_first)
{
    assert_true(cli_time_left(0, 0, 4, 1) < 0);
    assert_true(cli_time_left(300, 300, 400, 1) < 0);
    assert_true(cli_time_left(301, 300, 400, 1) < 0);
}

TEST(largest_counts)
{
    assert_float_equal(cli_time_left(UINT32_MAX - 3, UINT32_MAX - 2, UINT32_MAX, 5), 10, EXACT);
}
