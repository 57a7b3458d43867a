/* A flow's figures, put in order for the page: each wafer's way, and lanes of bars for stations and robots. It takes
 * run.flow of the document alone, so that it does not matter what kind of robots carried the wafers. */
(function (W) {
    'use strict';

    const MANY = 6; /* a station with more places has one lane that tells how full it is */

    const COLOURS = { process: 's0', waits: 's4', handled: 's5', clean: 's2', pump: 's3', vent: 's3', down: 'bad', stored: 's5',
        pick: 's0', place: 's0', swap: 's3', carry: 's1', way: 's5' };
    const WORDS = { process: 'process', waits: 'waits there', handled: 'a blade or the door', clean: 'clean',
        pump: 'pumps down', vent: 'vents', down: 'down', stored: 'lies there', pick: 'is picked', place: 'is placed',
        swap: 'swap', carry: 'is carried', way: 'moves empty' };

    const isTime = (t) => typeof t === 'number' && isFinite(t);
    const span = (from, to) => `${W.number(from, 3)} to ${W.number(to, 3)}\u00a0s, ${W.seconds(to - from)}`;

    /* A bar; one without duration is null. */
    function bar(kind, of, times, wafer) {
        const [from, to] = times;
        if (!isTime(from) || !isTime(to) || to <= from) {
            return null;
        }
        return { from, to, kind, wafer, colour: COLOURS[kind], text: wafer || WORDS[kind],
            say: `${of}: ${wafer ? wafer + ' ' : ''}${WORDS[kind]}, ${span(from, to)}` };
    }

    /* ------------------------------------------------------------------------------------------------- wafers */

    /* By name each wafer with its lot, where it came, and its visits by step. */
    function wafers(flow) {
        const all = new Map();
        flow.lots.forEach((lot) => lot.wafers.forEach((each) => all.set(each.name, Object.assign({}, each,
            { lot: lot.name, route: lot.route, visits: [], stays: [] }))));
        flow.visits.filter((visit) => all.has(visit.wafer)).forEach((visit) => all.get(visit.wafer).visits.push(visit));
        all.forEach((wafer) => wafer.visits.sort((a, b) => a.step - b.step));
        return all;
    }

    /* A wafer's stays, first where it lay at the beginning; times that have not come are null. */
    function staysOf(wafer) {
        const first = { station: wafer.station, slot: wafer.slot, step: 0, comes: wafer.came_s, lies: wafer.came_s,
            process: null, done: null };
        const others = wafer.visits.filter((visit) => visit.to !== null && isTime(visit.placed_s)).map((visit) => ({
            station: visit.to, slot: visit.to_slot, step: visit.step, comes: visit.place_s, lies: visit.placed_s,
            process: visit.process_s, done: visit.done_s }));
        const lain = (isTime(wafer.came_s) ? [first] : []).concat(others);
        return lain.map((stay) => {
            const next = wafer.visits.find((visit) => visit.step > stay.step);
            return Object.assign(stay, { wafer: wafer.name, taken: next ? next.pick_s : null,
                leaves: next ? next.picked_s : null });
        });
    }

    /* ------------------------------------------------------------------------------------------------- bars */

    /* In order; where two are at one time, as the wafers of an exchange, the one that begins first is shown. */
    function inOrder(bars) {
        let end = -Infinity;
        return bars.filter(Boolean).sort((a, b) => a.from - b.from || a.to - b.to).map((each) => {
            const from = Math.max(each.from, end);
            end = Math.max(each.to, end);
            return from === each.from ? each : Object.assign({}, each, { from });
        }).filter((each) => each.to > each.from);
    }

    /* The parts of the bars that none of the others covers; both are in order. */
    function without(bars, others) {
        const made = [];
        let next = 0;
        bars.forEach((each) => {
            let from = each.from;
            while (next > 0 && others[next - 1].to > from) {
                --next;
            }
            for (; next < others.length && others[next].from < each.to; ++next) {
                if (others[next].from > from) {
                    made.push(Object.assign({}, each, { from, to: others[next].from }));
                }
                from = Math.max(from, others[next].to);
            }
            if (from < each.to) {
                made.push(Object.assign({}, each, { from }));
            }
        });
        return made;
    }

    /* The parts of the bars that others cover, each told with the wafer that lies there; both are in order. */
    function beneath(bars, others) {
        const made = [];
        let first = 0;
        bars.forEach((each) => {
            while (first < others.length && others[first].to <= each.from) {
                ++first;
            }
            for (let i = first; i < others.length && others[i].from < each.to; ++i) {
                const from = Math.max(each.from, others[i].from), to = Math.min(each.to, others[i].to);
                const wafer = others[i].wafer;
                made.push(Object.assign({}, each, { from, to, wafer, text: `${wafer}, ${each.text}`,
                    say: `${each.say}, with ${wafer} inside` }));
            }
        });
        return made;
    }

    /* Each instant has one bar: of the first list that has one. */
    function layers(...lists) {
        return lists.reduce((above, list) => inOrder(above.concat(without(inOrder(list), above))), []);
    }

    const least = (t, end) => (isTime(t) ? Math.min(t, end) : null);

    /* Blade, door and process of a wafer in one place. */
    function firmBars(stay, name, until, end) {
        const { comes, lies, wafer } = stay;
        const begun = least(stay.process, until), over = least(stay.done, until);
        return [bar('handled', name, [comes, lies], wafer), bar('handled', name, [lies, begun], wafer),
            bar('process', name, [begun, over === null ? until : over], wafer),
            bar('handled', name, [stay.taken, isTime(stay.leaves) ? stay.leaves : end], wafer)].filter(Boolean);
    }

    /* A wafer's time in one place: what nothing else covers, and what gives way to cleans, pumps and failures. */
    function barsOf(stay, name, end) {
        const until = isTime(stay.taken) ? Math.min(stay.taken, end) : end;
        const free = [stay.done, stay.process].find(isTime);
        const from = free === undefined ? stay.lies : isTime(stay.done) ? free : until;
        const rest = bar(stay.step === 0 || stay.isLast ? 'stored' : 'waits', name, [from, until], stay.wafer);
        return { firm: firmBars(stay, name, until, end), rest: rest ? [rest] : [] };
    }

    /* ------------------------------------------------------------------------------------------------- stations */

    /* Stays of one place end at the latest when the next wafer comes: a carrier with wafers at their ends may be taken away. */
    function cutShort(stays, end) {
        stays.sort((a, b) => a.comes - b.comes);
        const until = (stay, next) => (next && !isTime(stay.taken) ? next.comes : end);
        return stays.map((stay, i) => Object.assign({ until: until(stay, stays[i + 1]) }, stay));
    }

    function placeLane(model, station, slot) {
        const { flow, end } = model;
        const name = station.slots > 1 ? `${station.name} ${slot}` : station.name;
        const found = cutShort((model.stays.get(station.name) || []).filter((stay) => stay.slot === slot), end);
        const parts = found.map((stay) => barsOf(stay, name, stay.until));
        const isHere = (doing) => doing.station === station.name && (doing.slot === null || doing.slot === slot);
        const doings = flow.doings.filter(isHere)
            .map((doing) => bar(doing.what, name, [doing.begin_s, Math.min(doing.end_s, end)]));
        const [firm, rest] = ['firm', 'rest'].map((key) => inOrder(parts.map((part) => part[key]).flat()));
        const apart = layers(doings);
        return { name, of: station.name, bars: layers(firm, beneath(apart, rest), apart, rest) };
    }

    /* A lane of a station with many places: how many of them have a wafer. */
    function levelLane(model, station) {
        const changes = [];
        const bySlot = new Map();
        (model.stays.get(station.name) || []).forEach((stay) => {
            bySlot.set(stay.slot, bySlot.get(stay.slot) || []);
            bySlot.get(stay.slot).push(stay);
        });
        bySlot.forEach((stays) => cutShort(stays, model.end).forEach((stay) => changes.push([stay.comes, 1],
            [isTime(stay.leaves) ? stay.leaves : stay.until, -1])));
        changes.sort((a, b) => a[0] - b[0]);
        const bars = [];
        let count = 0;
        changes.forEach(([t, step], i) => {
            count += step;
            const to = i + 1 < changes.length ? changes[i + 1][0] : model.end;
            if (count > 0 && to > t) {
                bars.push({ from: t, to, kind: 'stored', colour: COLOURS.stored, level: count / station.slots,
                    text: String(count), say: `${station.name}: ${count} of ${station.slots} places full, ${span(t, to)}` });
            }
        });
        return { name: station.name, of: station.name, bars };
    }

    /* Stations in the order in which wafers come to them. */
    function stationLanes(model) {
        const step = (station) => (model.stays.get(station.name) || []).reduce((first, stay) => Math.min(first, stay.step), 1e9);
        const stations = model.flow.stations.slice().sort((a, b) => step(a) - step(b) || (a.name < b.name ? -1 : 1));
        return stations.map((station) => (station.slots > MANY ? [levelLane(model, station)]
            : Array.from({ length: station.slots }, (_, i) => placeLane(model, station, i + 1)))).flat();
    }

    /* ------------------------------------------------------------------------------------------------- robots */

    const meeting = (robot, station, slot, t) => JSON.stringify([robot, station, slot, t]);

    /* The picks and places of one transfer; those of an exchange are one doing. */
    function handling(model, visit, name) {
        const { swaps, end } = model;
        const kind = (key, other) => (swaps.has(key) ? 'swap' : other);
        const taken = meeting(visit.robot, visit.from, visit.from_slot, visit.pick_s);
        const put = meeting(visit.robot, visit.to, visit.to_slot, visit.place_s);
        return [bar(kind(taken, 'pick'), name, [visit.pick_s, isTime(visit.picked_s) ? visit.picked_s : end], visit.wafer),
            bar(kind(put, 'place'), name, [visit.place_s, isTime(visit.placed_s) ? visit.placed_s : end], visit.wafer)];
    }

    function armLane(model, robot, arm, arms) {
        const { flow, end } = model;
        const name = arms > 1 ? `${robot} ${arm}` : robot;
        const visits = flow.visits.filter((visit) => visit.robot === robot && visit.arm === arm);
        const ways = (flow.ways || []).filter((way) => way.robot === robot)
            .map((way) => ({ from: way.begin_s, to: Math.min(way.end_s, end), way }));
        const carried = visits.filter((visit) => isTime(visit.picked_s)).map((visit) => bar('carry', name,
            [visit.picked_s, isTime(visit.place_s) ? visit.place_s : end], visit.wafer));
        const handled = visits.map((visit) => handling(model, visit, name)).flat();
        const still = ways.length > 0 ? without(inOrder(carried), inOrder(ways)) : [];
        const waits = still.map((each) => Object.assign(each, { kind: 'waits', colour: COLOURS.waits,
            say: `${name}: ${each.wafer} waits aboard, ${span(each.from, each.to)}` }));
        const empty = arm > 1 ? [] : ways.filter(({ from, to }) => !model.aboard(robot, from, to))
            .map(({ from, to, way }) => Object.assign(bar('way', name, [from, to]) || {}, { text: way.to,
                say: `${name}: moves empty from ${way.from} to ${way.to}, ${span(from, to)}` }));
        return { name, of: robot, bars: layers(handled, waits, carried, empty.filter((each) => isTime(each.from))) };
    }

    /* Tells whether the robot carries a wafer in a time. The one that ends last of those that begin before it counts. */
    function carrying(flow, end) {
        const by = new Map();
        flow.visits.filter((visit) => isTime(visit.picked_s)).forEach((visit) => {
            by.set(visit.robot, by.get(visit.robot) || []);
            by.get(visit.robot).push({ t: visit.picked_s, until: isTime(visit.place_s) ? visit.place_s : end });
        });
        by.forEach((list) => {
            list.sort((a, b) => a.t - b.t);
            list.forEach((each, i) => { each.until = i > 0 ? Math.max(each.until, list[i - 1].until) : each.until; });
        });
        return (robot, from, to) => {
            const list = by.get(robot) || [], at = W.tracks.indexOf(list, from);
            return at >= 0 && list[at].until >= to;
        };
    }

    function robotLanes(model) {
        return model.flow.robots.map(({ name }) => {
            const arms = model.flow.visits.reduce((most, visit) => (visit.robot === name ? Math.max(most, visit.arm) : most), 1);
            return Array.from({ length: arms }, (_, i) => armLane(model, name, i + 1, arms));
        }).flat();
    }

    /* ------------------------------------------------------------------------------------------------- all */

    const LISTS = ['robots', 'stations', 'stays', 'lots', 'visits', 'doings', 'ways', 'path', 'gains', 'waits', 'windows',
        'gaps'];

    /* Its route ends there: the document tells, or nothing is done there. */
    const isOver = (wafer, stay) => (wafer.fate ? wafer.fate !== 'inside' : !isTime(stay.process));

    /* Fills in each wafer's stays, and returns those of each station. */
    function staysByStation(all) {
        const stays = new Map();
        all.forEach((wafer) => {
            wafer.stays = staysOf(wafer);
            const last = wafer.stays[wafer.stays.length - 1];
            wafer.stays.forEach((stay) => {
                stay.isLast = stay === last && !isTime(stay.taken) && isOver(wafer, stay);
                stays.set(stay.station, stays.get(stay.station) || []);
                stays.get(stay.station).push(stay);
            });
        });
        return stays;
    }

    /* The flow of a document, each list there; null without one. */
    function read(doc) {
        const told = doc.run.flow;
        if (!told || typeof told !== 'object') {
            return null;
        }
        const flow = Object.assign({}, told);
        LISTS.forEach((name) => { flow[name] = Array.isArray(told[name]) ? told[name] : []; });
        const all = wafers(flow);
        const stays = staysByStation(all);
        const end = flow.counted_s > 0 ? flow.counted_s : doc.duration;
        const picks = new Set(flow.visits.map((visit) => meeting(visit.robot, visit.from, visit.from_slot, visit.pick_s)));
        const puts = flow.visits.filter((visit) => isTime(visit.place_s))
            .map((visit) => meeting(visit.robot, visit.to, visit.to_slot, visit.place_s));
        const swaps = new Set(puts.filter((key) => picks.has(key)));
        const model = { flow, end, wafers: all, stays, swaps, aboard: carrying(flow, end) };
        return Object.assign(model, { lanes: () => stationLanes(model).concat(robotLanes(model)) });
    }

    W.flowData = { read, COLOURS, isTime };
}(window.Waferhand));
