/* The list of curves: groups of panels, each with its curves and limits, taken from the document's tracks. A curve is { name,
 * colour, unit, decimals, t, read(i, share), at(t) }; `read` gives a value between its points i and i + 1, null in a gap. A
 * limit is { value, text, below }: the allowed values lie below it, or above. `most` is the widest range of values that is
 * worth showing. */
(function (W) {
    'use strict';

    const DEGREES = 180 / Math.PI;
    const some = (track) => !!(track && track.t && track.t.length > 0);
    const valued = (values) => Array.isArray(values) && values.some((value) => value !== null);
    const times = (value, factor) => (value === null ? null : factor * value);

    /* A curve of the document, or its slope. */
    function smooth(track, slope, factor) {
        return { t: track.t, read: (i, share) => times(W.tracks.cubic(track, i, share, slope), factor), smooth: true,
            at: (t) => times(W.tracks.curve(track, t, slope), factor) };
    }

    /* Straight lines from value to value. */
    function lines(t, values) {
        return { t, read: (i) => values[i], at: (now) => W.tracks.linear(t, values, now) };
    }

    const MEASURES = [
        { key: 'dr_proj_z', name: '|dr_proj_z|', unit: 'mm', decimals: 4, limit: 'projz', below: true,
            most: (limit) => [0, 6 * limit] },
        { key: 'dr_proj_xy', name: '|dr_proj_xy|', unit: 'mm', decimals: 4, limit: 'projxy', below: true,
            most: (limit) => [0, 3 * limit] },
        { key: 'n1_proj_n2', name: 'n1_proj_n2', unit: '', decimals: 6, limit: 'planar', below: false,
            most: (limit) => [1 - 2 * (1 - limit), 1] },
    ];

    function limitOf(doc, measure) {
        const value = doc.limits[measure.limit];
        return typeof value === 'number' ? [{ value, below: measure.below,
            text: `limit ${value}${measure.unit && '\u00a0' + measure.unit}` }] : [];
    }

    /* The name of the nearest wafer at a time, for the legend. */
    function nearest(doc, i) {
        const track = doc.tracks.nearest[i];
        return (t) => (track ? doc.names.wafers[W.tracks.step(track.t, track.v, t)] || '' : '');
    }

    function proximityPanel(doc, track, name, measure, i) {
        const curve = Object.assign(smooth(track[measure.key], false, 1), { name: measure.name, colour: i, unit: measure.unit,
            decimals: measure.decimals, note: nearest(doc, i) });
        return { title: `${name}: ${measure.name}`, unit: measure.unit, curves: [curve], limits: limitOf(doc, measure),
            zero: measure.below, most: limitOf(doc, measure).map((limit) => measure.most(limit.value))[0] };
    }

    function proximity(doc) {
        const panels = [];
        doc.tracks.proximity.forEach((track, i) => MEASURES.filter((measure) => doc.grows || some(track[measure.key]))
            .forEach((measure) => panels.push(
                proximityPanel(doc, track, doc.names.grippers[i] || `gripper ${i + 1}`, measure, i))));
        return { id: 'proximity', title: 'Proximity of each gripper to its nearest wafer', panels,
            why: 'No gripper came near a wafer, or the document does not hold how near.' };
    }

    /* There is one panel for the axes in mm, one for those that turn, and one for those whose unit is not known. */
    function axisPanel(doc, unit, speed) {
        const factor = unit === 'rad' ? DEGREES : 1;
        const per = speed ? '/s' : '';
        const shown = { rad: `\u00b0${per}`, mm: `mm${per}` }[unit] || `mm${per} or rad${per}`;
        const curves = [];
        doc.tracks.axes.forEach((track, i) => {
            const axis = doc.names.axes[i] || { name: `axis ${i + 1}`, unit: null };
            if (axis.unit === unit && some(track)) {
                curves.push(Object.assign(smooth(track, speed, factor), { name: axis.name, colour: i, unit: shown,
                    decimals: speed ? 2 : 3, bounds: bounds(axis, factor, speed) }));
            }
        });
        return { title: speed ? 'Speeds' : 'Positions', unit: shown, curves, limits: [], zero: speed };
    }

    /* The limits of an axis, in words. */
    function bounds(axis, factor, speed) {
        if (speed) {
            return axis.speed > 0 ? `at most ${W.figure(axis.speed * factor)}` : '';
        }
        return typeof axis.low === 'number' && typeof axis.high === 'number'
            ? `${W.figure(axis.low * factor)} to ${W.figure(axis.high * factor)}` : '';
    }

    function axes(doc) {
        const panels = [['mm', false], ['rad', false], [null, false], ['mm', true], ['rad', true], [null, true]]
            .map(([unit, speed]) => axisPanel(doc, unit, speed)).filter((panel) => panel.curves.length > 0);
        return { id: 'axes', title: 'Axes', panels, why: 'The document holds no positions of axes.' };
    }

    function clearances(doc) {
        const panels = doc.tracks.clearances.filter((track) => some(track) && valued(track.gap))
            .map((track, i) => ({ title: W.words(track.pair), unit: 'mm', zero: true,
                curves: [Object.assign(lines(track.t, track.gap), { name: 'gap', colour: i, unit: 'mm', decimals: 3 })],
                limits: track.limit > 0 ? [{ value: track.limit, below: false, text: `limit ${track.limit}\u00a0mm` }]
                    : [] }));
        return { id: 'clearances', title: 'Clearances', panels,
            why: 'Clearances are not shown: collisions were not checked in this run, or nothing came near.' };
    }

    const groups = (doc) => [proximity(doc), axes(doc), clearances(doc)];

    W.curves = { groups, smooth };
}(window.Waferhand));
