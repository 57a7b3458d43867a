/* An update never asks for memory, whatever it finds: malloc and its kin are replaced by ones that count. */
#include "link/outputs.h"
#include "support/heap.h"
#include "support/outputs.h"
#include "support/support.h"

#if defined(WH_TEST_COUNTS_HEAP)

/* Updates now and once what is there has settled; only this is counted. */
static unsigned long calls_while_updating(outputs_fixture_t *f) {
    const unsigned long before = calls;
    (void)wh_outputs_update(&f->reader, f->now_us);
    f->now_us += WH_OUTPUTS_SETTLE_US;
    (void)wh_outputs_update(&f->reader, f->now_us);
    return calls - before;
}

static void nothing_is_allocated(void **state) {
    (void)state;
    static const char *const texts[] = {"0 1", "", "1", "1 1 1", "garbage", "1 0"};
    outputs_fixture_t f;
    outputs_begin(&f);
    for (int i = 0; i < 600; ++i) {
        outputs_put(f.path, texts[i % 6]);
        assert_int_equal(calls_while_updating(&f), 0);
    }
    assert_int_equal(unlink(f.path), 0);
    assert_int_equal(calls_while_updating(&f), 0);
    assert_int_equal(symlink("outputs.txt", f.path), 0);
    assert_int_equal(calls_while_updating(&f), 0);
    assert_int_equal(unlink(f.path), 0);
    assert_int_equal(mkdir(f.path, 0777), 0);
    assert_int_equal(calls_while_updating(&f), 0);
    assert_int_equal(f.reader.counters.reports, 503);
    outputs_teardown(&f);
}

#else

static void nothing_is_allocated(void **state) {
    (void)state;
    skip();
}

#endif

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_count_counts),
        cmocka_unit_test(nothing_is_allocated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
