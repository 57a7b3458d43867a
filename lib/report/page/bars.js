/* The content of the lanes: each lane has its name and its bars { from, to, text, colour, hatch, seek } or a curve. */
(function (W) {
    'use strict';

    /* The intervals in which a track of steps has a value. */
    function intervals(track, wanted, end) {
        const made = [];
        track.t.forEach((t, i) => {
            const to = i + 1 < track.t.length ? track.t[i + 1] : end;
            const last = made[made.length - 1];
            if (track.v[i] === wanted && last && last.to === t) {
                last.to = to;
            } else if (track.v[i] === wanted) {
                made.push({ from: t, to });
            }
        });
        return made;
    }

    const some = (track) => !!(track && track.t && track.t.length > 0);

    function signalLanes(doc, name, i) {
        const lanes = [];
        const { valves, vacuum, sensors } = doc.tracks;
        const bars = (track, wanted, text) => intervals(track, wanted, doc.duration)
            .map((bar) => Object.assign(bar, { text, colour: `s${i % 6}` }));
        if (some(valves[i])) {
            lanes.push({ name: `${name} valve`, bars: bars(valves[i], 0, 'open') });
        }
        if (some(vacuum[i])) {
            lanes.push({ name: `${name} vacuum`, bars: [], curve: W.curves.smooth(vacuum[i], false, 1), colour: `s${i % 6}` });
        }
        if (some(sensors[i])) {
            lanes.push({ name: `${name} sensor`, bars: bars(sensors[i], 1, 'wafer') });
        }
        return lanes;
    }

    function signals(doc) {
        const lanes = [].concat(...doc.names.grippers.map((name, i) => signalLanes(doc, name, i)));
        return { id: 'signals', title: 'Valves, vacuum and sensors', lanes,
            note: doc.tracks.vacuum.some(some) ? '' : 'The vacuum is not shown: in this run it was ideal, or was not recorded.',
            why: 'The document holds no valves, vacuum or sensors.' };
    }

    /* A lane for each gripper, with the wafers that it held. */
    function holders(doc) {
        const lanes = doc.names.grippers.map((name) => ({ name, bars: [] }));
        doc.tracks.wafers.forEach((states, wafer) => states.forEach((state, i) => {
            const lane = lanes[state.holder];
            const to = i + 1 < states.length ? states[i + 1].t : doc.duration;
            const last = lane && lane.bars[lane.bars.length - 1];
            if (last && last.wafer === wafer && last.to === state.t) {
                last.to = to;
            } else if (lane) {
                lane.bars.push({ from: state.t, to, wafer, text: doc.names.wafers[wafer], colour: `s${state.holder % 6}` });
            }
        }));
        lanes.forEach((lane) => lane.bars.sort((a, b) => a.from - b.from));
        return { id: 'holders', title: 'Wafers and their holders', lanes: doc.tracks.wafers.length > 0 ? lanes : [],
            why: 'The document does not hold who held what.' };
    }

    const COLOURS = { loaded: 's0', empty: 's5', vacuum: 's3', handover: 's2', waiting: 's4' };

    /* If there are several robots, each has its name. */
    function laneName(entry) {
        if (entry.resource === 'robot') {
            return entry.gripper || 'robot';
        }
        return `${entry.gripper} ${entry.resource === 'gripper' ? 'holds' : entry.resource}`;
    }

    /* How the robot, the chucks and the doors spend their time; grippers and valves have lanes of their own above. */
    function busy(doc) {
        const lanes = new Map();
        (doc.run.gantt || []).filter((entry) => ['robot', 'chuck', 'door'].includes(entry.resource)).forEach((entry) => {
            const name = laneName(entry);
            if (!lanes.has(name)) {
                lanes.set(name, { name, bars: [] });
            }
            lanes.get(name).bars.push({ from: entry.from_s, to: entry.to_s, text: entry.what,
                colour: COLOURS[entry.what] || 's1' });
        });
        return Array.from(lanes.values());
    }

    /* Without an end yet, it goes on. */
    const endOf = (end, doc) => (typeof end === 'number' ? end : doc.duration);

    /* The waits of a script with tasks: who waits, and for what. */
    const waits = (doc) => (doc.run.waits || []).map((wait) => ({ from: wait.from_s, to: endOf(wait.to_s, doc),
        text: `${wait.task > 0 ? `task ${wait.task}` : 'script'}: ${wait.for}`, colour: COLOURS.waiting }));

    /* Gives bars that overlap lanes of their own. */
    function apart(name, bars) {
        const lanes = [];
        bars.forEach((bar) => {
            let lane = lanes.find((each) => each.bars[each.bars.length - 1].to <= bar.from + 1e-9);
            if (!lane) {
                lane = { name: lanes.length === 0 ? name : 'beside them', bars: [] };
                lanes.push(lane);
            }
            lane.bars.push(bar);
        });
        return lanes;
    }

    /* The robot, of several, that carries a command out. The command's text says it at its end; the name may be quoted. */
    const robotOf = (text) => (/.* robot=("?)(.*)\1$/.exec(text || '') || [])[2];

    /* Each of several robots has its commands in lanes of its own; all others come first. */
    function commandLanes(doc) {
        const by = new Map([[undefined, []]]);
        doc.commands.filter((command) => typeof command.begin_s === 'number').forEach((command) => {
            const robot = robotOf(command.text);
            by.set(robot, by.get(robot) || []);
            by.get(robot).push({ from: command.begin_s, to: endOf(command.end_s, doc), text: command.text,
                colour: command.error ? 'bad' : 's0', alternate: true });
        });
        const names = Array.from(by.keys()).filter((name) => name).sort();
        return apart('commands', by.get(undefined)).concat(...names.map((name) => apart(`${name} commands`, by.get(name))));
    }

    function commands(doc) {
        const lanes = commandLanes(doc).concat(apart('waits', waits(doc)), busy(doc));
        return { id: 'commands-chart', title: 'Commands, and what the time goes into', lanes,
            why: 'The document holds no commands: a log of moves alone has none.' };
    }

    const groups = (doc) => [signals(doc), holders(doc), commands(doc)];

    W.bars = { groups };
}(window.Waferhand));
