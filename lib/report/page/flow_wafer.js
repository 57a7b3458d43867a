/* One wafer's history: where it lay, who carried it, and what it waited for. */
(function (W) {
    'use strict';

    const wafer = { name: null, model: null, host: null, changed: [] };
    const { isTime } = W.flowData;

    /* A transfer in words: its times, and what it is. */
    function transfer(visit) {
        const arm = `${visit.robot}, arm ${visit.arm}`;
        return [[visit.pick_s, visit.picked_s, `${arm}: is picked out of ${visit.from} ${visit.from_slot}`],
            [visit.picked_s, visit.place_s, `${arm}: is carried`],
            [visit.place_s, visit.placed_s, `${arm}: is placed into ${visit.to} ${visit.to_slot}`]];
    }

    const LASTS = { lost: 'is lost' };

    function stayed(stay, end, fate) {
        const place = `${stay.station} ${stay.slot}`, isDone = isTime(stay.done);
        const what = stay.isLast ? LASTS[fate] || 'is at its end' : stay.step === 0 ? 'lies there' : 'waits';
        const until = isTime(stay.taken) ? stay.taken : stay.isLast ? null : end;
        const made = [[stay.lies, stay.process, `${place}: the door shuts`],
            [stay.process, stay.done, `${place}: process`, 'good']];
        const rest = [stay.lies, stay.process, stay.done].filter(isTime).pop();
        const after = [rest, until, `${place}: ${what}`, what === 'waits' ? 'warn' : null];
        return isTime(stay.process) ? made.concat(isDone ? [after] : []) : [after];
    }

    /* All that happened to it, by the begins: { from, to, what, kind }; to is null if nobody knows. */
    function rowsOf(of, end) {
        return of.visits.map(transfer).concat(of.stays.map((stay) => stayed(stay, end, of.fate))).flat()
            .filter(([from, to]) => isTime(from) && (!isTime(to) || to > from))
            .map(([from, to, what, kind]) => ({ from, to: isTime(to) ? to : null, what, kind }))
            .sort((a, b) => a.from - b.from || (a.to || end) - (b.to || end));
    }

    function moment(t) {
        return W.element('button', { type: 'button', class: 'time', title: 'Show this time', click() {
            W.clock.seek(t);
            W.say(`time ${t.toFixed(3)} seconds`);
        } }, W.number(t, 3));
    }

    function table(of) {
        const rows = rowsOf(of, wafer.model.end).map((each) => W.tables.row([{ numeric: moment(each.from) },
            W.tables.num(W.number(each.to, 3)), W.tables.num(each.to === null ? W.DASH : W.number(each.to - each.from, 3)),
            each.what], each.kind));
        const heads = ['from (s)', 'to (s)', 'takes (s)', 'what'].map((text, i) => W.element('th',
            { scope: 'col', class: i < 3 ? 'number' : null }, text));
        return W.element('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': `History of ${of.name}` },
            W.element('table', {}, W.element('thead', {}, W.element('tr', {}, ...heads)), W.element('tbody', {}, ...rows)));
    }

    /* In the tool: from the first pick to the last placing. */
    function facts(of) {
        const first = of.visits[0], last = of.visits[of.visits.length - 1];
        const about = [of.lot ? `lot ${of.lot}` : null, of.route ? `route ${of.route}` : null];
        const whole = first && isTime(last.placed_s) ? W.seconds(last.placed_s - first.pick_s) : null;
        const fates = { lost: 'lost where a station failed', shortened: 'without steps whose stations failed' };
        const took = whole ? `${whole} from the first pick to the last placing` : first ? 'not at its end' : 'never taken';
        const fate = fates[of.fate];
        return about.concat(took, fate).filter(Boolean).join('; ');
    }

    function paint() {
        const of = wafer.model.wafers.get(wafer.name);
        const body = wafer.host.querySelector('.history');
        body.textContent = '';
        wafer.select.value = of ? wafer.name : '';
        body.append(...(of ? [W.element('p', { class: 'note' }, facts(of)), table(of)]
            : [W.why('Choose a wafer here, or a bar above: its history, and its way through all lanes.')]));
        wafer.changed.forEach((listener) => listener());
    }

    /* Shows a wafer's history; null: none. */
    wafer.show = function (name) {
        wafer.name = wafer.model.wafers.has(name) ? name : null;
        paint();
        W.say(wafer.name ? `history of ${wafer.name}` : 'no wafer');
    };

    wafer.on = (listener) => wafer.changed.push(listener);

    /* A button with the wafer's name that shows its history. */
    wafer.button = function (name) {
        return W.element('button', { type: 'button', class: 'time', title: 'Show its history', click() {
            wafer.show(name);
            wafer.host.scrollIntoView({ block: 'nearest' });
            wafer.select.focus();
        } }, name);
    };

    wafer.section = function (model) {
        wafer.model = model;
        wafer.select = W.element('select', { id: 'which', change: () => wafer.show(wafer.select.value) }, W.element('option',
            { value: '' }, 'none'), ...Array.from(model.wafers.keys(), (name) => W.element('option', { value: name }, name)));
        wafer.host = W.element('section', { class: 'group', id: 'wafer' }, W.element('h2', {}, W.element('label', {}, 'Wafer ',
            wafer.select)), W.element('div', { class: 'history' }));
        paint();
        return wafer.host;
    };

    W.flowWafer = wafer;
}(window.Waferhand));
