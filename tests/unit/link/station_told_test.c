/* The own doings of stations, as text on the channel of motion control. */
#include "support/support.h"

#include "link/station_told.h"

static void what_is_written_is_read(void **state) {
    (void)state;
    const wh_station_event_record_t events[] = {
        {3, {WH_CLOCK_PROCESS_BEGINS, 0, 9, WH_FLOW_BOTH, 5770000, 60000000}, WH_LOAD_PORT_STANDS, ""},
        {0,
         {WH_CLOCK_PUMP_ENDS, WH_FLOW_NONE, WH_FLOW_NONE, WH_FLOW_VACUUM, INT64_MAX, 0},
         WH_LOAD_PORT_STANDS,
         ""},
        {3, {WH_CLOCK_CLEAN_BEGINS, 24, WH_FLOW_NONE, WH_FLOW_BOTH, 0, 1}, WH_LOAD_PORT_STANDS, ""},
        {2,
         {WH_CLOCK_PORT_ENDS, WH_FLOW_NONE, WH_FLOW_NONE, WH_FLOW_BOTH, 7, 3},
         WH_LOAD_PORT_UNDOCK,
         "C 1 x=2"},
        {2, {WH_CLOCK_CARRIER_WENT, WH_FLOW_NONE, WH_FLOW_NONE, WH_FLOW_BOTH, 7, 3}, WH_LOAD_PORT_TP3, ""},
    };
    for (size_t i = 0; i < sizeof events / sizeof events[0]; ++i) {
        char text[WH_STATION_TOLD_BYTES];
        wh_station_event_record_t read;
        wh_station_told_write(&events[i], text);
        assert_true(wh_station_told_read(text, 4, 10, &read));
        assert_int_equal(read.station, events[i].station);
        assert_int_equal(read.event.kind, events[i].event.kind);
        assert_int_equal(read.event.slot, events[i].event.slot);
        assert_int_equal(read.event.wafer, events[i].event.wafer);
        assert_int_equal(read.event.side, events[i].event.side);
        assert_int_equal(read.event.at_us, events[i].event.at_us);
        assert_int_equal(read.event.us, events[i].event.us);
        assert_int_equal(read.step, events[i].step);
        assert_string_equal(read.carrier, events[i].carrier);
    }
}

static void other_texts_are_refused(void **state) {
    (void)state;
    static const char *const texts[] = {
        "",
        "passed; commands 12",
        "kind=process_begins station=4 slot=1 wafer=0 side=both at=1 us=1",
        "kind=process_begins station=-1 slot=1 wafer=0 side=both at=1 us=1",
        "kind=process_begins station=0 slot=0 wafer=0 side=both at=1 us=1",
        "kind=process_begins station=0 slot=1 wafer=10 side=both at=1 us=1",
        "kind=process_begins station=0 slot=1 wafer=0 side=inside at=1 us=1",
        "kind=process_dances station=0 slot=1 wafer=0 side=both at=1 us=1",
        "kind=process_begins station=0 slot=1 wafer=0 side=both at=-1 us=1",
        "kind=process_begins station=0 slot=1 wafer=0 side=both at=1",
        "kind=port_begins station=0 slot=-1 wafer=-1 side=both at=1 us=1",
        "kind=port_begins station=0 slot=-1 wafer=-1 side=both at=1 us=1 step=jump carrier=C1",
        "kind=port_begins station=0 slot=-1 wafer=-1 side=both at=1 us=1 step=dock",
        ("kind=port_begins station=0 slot=-1 wafer=-1 side=both at=1 us=1 step=dock carrier="
         "0123456789012345678901234567890123456789012345678901234567890123456789"),
    };
    for (size_t i = 0; i < sizeof texts / sizeof texts[0]; ++i) {
        wh_station_event_record_t read;
        if (wh_station_told_read(texts[i], 4, 10, &read)) {
            fail_msg("read: %s", texts[i]);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_read),
        cmocka_unit_test(other_texts_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
