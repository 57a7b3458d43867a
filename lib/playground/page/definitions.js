/* The fields and words of layouts and scripts, read from the text of `waferhand definitions`: annotations for the Lua language
 * server. */
(function (P) {
    'use strict';

    const definitions = { classes: new Map(), aliases: new Map(), functions: new Map() };

    /* Where a type ends that stands before a text: at a blank, but not within brackets or behind a comma or a colon. */
    function endOfType(text) {
        let depth = 0;
        for (let i = 0; i < text.length; ++i) {
            depth += '<({['.includes(text[i]) ? 1 : '>)}]'.includes(text[i]) ? -1 : 0;
            if (text[i] === ' ' && depth === 0 && !',:|'.includes(text[i - 1])) {
                return i;
            }
        }
        return text.length;
    }

    function typed(rest) {
        const end = endOfType(rest);
        return { type: rest.slice(0, end), text: rest.slice(end + 1) };
    }

    /* One line at a time; `now` has what is being read. */
    const RULES = [
        [/^---@class waferhand\.(\w+)/, (now, [, name]) => {
            now.fields = new Map();
            definitions.classes.set(name, { text: now.text, fields: now.fields });
        }],
        [/^---@field (\w+)(\??) (.*)$/, (now, [, name, optional, rest]) => {
            now.fields.set(name, Object.assign({ isRequired: !optional }, typed(rest)));
        }],
        [/^---@alias waferhand\.(\w+) (.*)$/, (now, [, name, type]) => definitions.aliases.set(name, type)],
        [/^---@param (\w+)\??\s+(.*)$/, (now, [, name, rest]) => now.parameters.push(Object.assign({ name }, typed(rest)))],
        [/^function ([\w.:]+)\((.*)\)/, (now, [, name, list]) => {
            definitions.functions.set(name, { text: now.text, parameters: now.parameters, list });
            now.parameters = [];
        }],
        [/^---(?!@)(.*)$/, (now, [, text]) => { now.text = text; }],
    ];

    definitions.read = function (text) {
        const now = { text: '', fields: new Map(), parameters: [] };
        (text || '').split('\n').forEach((line) => {
            const rule = RULES.find(([pattern]) => pattern.test(line));
            if (rule) {
                rule[1](now, rule[0].exec(line));
            }
        });
    };

    /* The names of the classes that a type may be, with those of its aliases. */
    definitions.classesOf = function (type) {
        const found = [];
        for (const [, name] of (type || '').matchAll(/waferhand\.(\w+)/g)) {
            found.push(...(definitions.aliases.has(name) ? definitions.classesOf(definitions.aliases.get(name)) : [name]));
        }
        return found.filter((name) => definitions.classes.has(name));
    };

    /* The texts that a type lists, with their quotes; true and false of a boolean. */
    definitions.valuesOf = (type) => (/^boolean/.test(type) ? ['true', 'false'] : (type || '').match(/"[^"]*"/g) || []);

    definitions.field = (classes, name) => classes.map((each) => definitions.classes.get(each).fields.get(name)).find(Boolean);

    P.definitions = definitions;
}(window.Playground));
