/* Reads the document that the page shows, once; a part that is missing gets a default. */
(function (W) {
    'use strict';

    const list = (value) => (Array.isArray(value) ? value : []);
    const object = (value) => (value && typeof value === 'object' && !Array.isArray(value) ? value : {});

    function names(from) {
        return { wafers: list(from.wafers), grippers: list(from.grippers), axes: list(from.axes),
            stations: list(from.stations), doors: list(from.doors) };
    }

    function machine(from) {
        const chain = (of) => (of ? Object.assign({ axes: [], links: [], r: [0, 0, 0], q: [0, 0, 0, 1] }, of) : null);
        const arm = (of) => ({ robot: of.robot || 0, number: of.number || 0, first: of.first || 0, chain: chain(of.chain),
            lengths: Object.assign({ reach: 0, link: 1 }, of.arm) });
        const arms = list(from.arms).length > 0 ? from.arms : [from];
        return { grippers: list(from.grippers), links: list(from.links), bodies: list(from.bodies), doors: list(from.doors),
            arms: arms.map(arm) };
    }

    function tracks(from, robot) {
        const kinds = ['axes', 'grippers', 'wafers', 'valves', 'sensors', 'nearest', 'vacuum', 'proximity', 'clearances'];
        return kinds.reduce((all, kind) => Object.assign(all, { [kind]: list(from[kind]) }), { machine: machine(robot) });
    }

    /* A wafer that a carrier brings or takes is no fault. */
    const kindOf = (event) => (event.fault_kind === 'wafer_placed' ? event.fault_kind : event.kind);

    /* An event with its time in seconds. */
    const timed = (event) => Object.assign({ t: event.utime / 1e6 }, event, { kind: kindOf(event) });

    /* Events in order; several may share one time. */
    function events(run) {
        return list(run.events).filter((event) => event && typeof event.utime === 'number').map(timed)
            .sort((a, b) => a.t - b.t);
    }

    /* The last time in the document, for one that does not give its length. */
    function lastTime(doc) {
        const last = (track) => (track && track.t && track.t.length > 0 ? track.t[track.t.length - 1] : 0);
        const moved = doc.tracks.axes.concat(doc.tracks.grippers).map(last);
        return Math.max(0.001, ...moved, ...doc.events.slice(-1).map((event) => event.t));
    }

    const NOTHING = { begin_s: 0, duration_s: 0, slice_s: 0.001, title: '', source: '', version: '', reproduce: '',
        thinning: null, scene: null };

    const SCAN = { number: 0, begin_s: 0, end_s: 0, gripper: 0, station: null, sure: false, words: ['no estimate'], circle: null,
        mark: null, theta: [], rho: [], residual: [], counts: [] };

    const scans = (from) => list(from.scans).map((scan) => Object.assign({}, SCAN, object(scan)));

    const CENTRING = { at_s: 0, station: '', gripper: '', wafer: null, sure: false, words: ['no estimate'], known: {},
        crossings: [], candidates: [] };

    const centrings = (run) => list(run.centrings).map((each) => Object.assign({}, CENTRING, object(each)));

    function lists(from, run) {
        return { notes: list(from.notes), slots: list(from.slots), marks: list(from.marks), scans: scans(from),
            centrings: centrings(run), commands: list(run.commands), events: events(run),
            expectations: list(run.expectations) };
    }

    function complete(given) {
        const from = Object.assign({}, NOTHING, given);
        const run = object(from.run);
        const doc = Object.assign(lists(from, run), {
            title: from.title || run.script || 'Report', source: from.source, version: from.version,
            reproduce: from.reproduce, parameters: object(from.parameters), run, names: names(object(from.names)),
            wafer: Object.assign({ diameter: 300, thickness: 0.775 }, object(from.wafer)), limits: object(from.limits),
            thinning: from.thinning, tracks: tracks(object(from.tracks), object(from.machine)),
            scene: from.scene, scansLeftOut: from.scans_left_out || 0, slices: from.slices,
            slice: from.slice_s > 0 ? from.slice_s : 0.001, begin: Math.max(from.begin_s, 0), grows: false,
        });
        doc.duration = from.duration_s > 0 ? from.duration_s : lastTime(doc);
        if (from.now) {
            W.growth.begin(doc, from.now);
        }
        return doc;
    }

    /* Promises what the source has. */
    async function unpack() {
        return object(await W.source.take());
    }

    /* Promises the document, or null; `W.fault` then tells why. */
    async function read() {
        try {
            return complete(await unpack());
        } catch (error) {
            W.fault = error.message;
            return null;
        }
    }

    W.document = { read, complete, unpack, timed };
}(window.Waferhand));
