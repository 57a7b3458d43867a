/* A list hides and shows parts of the cell by groups: the robot, stations, wafers, obstacles, and each of them. The hidden
 * parts are a set of keys: "stations" for all of a group, "stations.2" for the second. */
(function (W) {
    'use strict';

    const GROUPS = [['robot', 'Robot'], ['stations', 'Stations'], ['wafers', 'Wafers'], ['obstacles', 'Obstacles']];
    const parts = { groups: [], hidden: new Set(), of: {}, boxes: {} };

    /* The group of a node; a chuck's gripper belongs to its station. */
    function groupOf(doc, { kind, index }) {
        const chuck = kind === 'gripper' && (doc.tracks.machine.grippers[index] || { axis: null }).axis !== null;
        const groups = { base: 'robot', link: 'robot', gripper: chuck ? 'stations' : 'robot', station: 'stations',
            wafer: 'wafers', obstacle: 'obstacles', door: 'obstacles' };
        return groups[kind];
    }

    function walk(nodes, visit) {
        nodes.forEach((node) => {
            visit(node);
            walk(node.children, visit);
        });
    }

    /* The robot's column and links are one member. */
    const memberName = (node) => (node.kind === 'base' || node.kind === 'link' ? 'arm' : node.name.replace(/^station /, ''));

    function collect(doc, roots) {
        const groups = GROUPS.map(([key, text]) => ({ key, text, members: [] }));
        walk(roots, (node) => {
            const group = groups.find(({ key }) => key === groupOf(doc, node));
            if (!group) {
                return;
            }
            const arm = node.kind === 'base' || node.kind === 'link';
            const known = arm && group.members.find((member) => member.text === 'arm');
            const member = known || { key: `${group.key}.${group.members.length + 1}`, text: memberName(node) };
            if (!known) {
                group.members.push(member);
            }
            parts.of[W.gltf.key(node.kind, node.index)] = [group.key, member.key];
        });
        return groups.filter((group) => group.members.length > 0);
    }

    /* True if a node, given by its kind and index, is hidden. */
    parts.isHidden = (kind, index) => (parts.of[W.gltf.key(kind, index)] || []).some((key) => parts.hidden.has(key));

    const known = (key) => parts.groups.some((group) => group.key === key || group.members.some((member) => member.key === key));

    /* Hides just these; unknown keys are ignored. */
    parts.set = function (keys) {
        parts.hidden = new Set(keys.filter(known));
        Object.entries(parts.boxes).forEach(([key, each]) => { each.checked = !parts.hidden.has(key); });
        parts.changed();
    };

    parts.text = () => Array.from(parts.hidden).join(',');

    function box(key, text) {
        const made = W.element('input', { type: 'checkbox', checked: true, 'data-name': key, change: () => {
            const others = Array.from(parts.hidden).filter((other) => other !== key);
            parts.set(made.checked ? others : others.concat(key));
            W.say(`${text} ${made.checked ? 'shown' : 'hidden'}`);
        } });
        parts.boxes[key] = made;
        return W.element('label', {}, made, text);
    }

    function list(group) {
        const head = box(group.key, group.text);
        return group.members.length < 2 ? W.element('div', { class: 'one' }, head) : W.element('details', {},
            W.element('summary', {}, head, W.element('small', {}, ` ${group.members.length}`)),
            ...group.members.map((member) => box(member.key, member.text)));
    }

    /* Makes the list; `changed` is called when something is hidden or shown. */
    parts.make = function (doc, roots, changed) {
        parts.groups = collect(doc, roots);
        parts.changed = changed;
        const all = W.element('button', { type: 'button', click: () => parts.set([]) }, 'Show all');
        return W.element('div', { id: 'parts', class: 'sheet', hidden: true, role: 'group', 'aria-label': 'Parts' },
            ...parts.groups.map(list), all);
    };

    W.parts = parts;
}(window.Waferhand));
