// SPDX-License-Identifier: MIT
// node tables.mjs HEADER USER JS INL: writes what the package knows of lightbin.h, so that nobody copies it by hand.
//   JS   a module with the structs that the JavaScript in USER names, as 32-bit WebAssembly lays them out, and their
//        enums. An enum maps the names of its values, in kebab-case, to their numbers. A struct has its size and maps
//        the names of its members, in camelCase, to [type, offset, more]; `more` names the enum or the struct that the
//        member holds.
//   INL  the same sizes and offsets as static_asserts, for the compiler to check
import fs from 'node:fs';

const [path, user, js, inl] = process.argv.slice(2);
const header = fs.readFileSync(path, 'utf8').replaceAll(/\/\* ----.*?\*\//g, '');
const camel = name => name.replaceAll(/_([a-z])/g, (_, letter) => letter.toUpperCase());
const kebab = name => name.toLowerCase().replaceAll('_', '-');
const bare = type => type.replace(/^lightbin_/, '');

const enums = {};
for (const [, name, body] of header.matchAll(/typedef enum lightbin_(\w+) \{(.*?)\} lightbin_\1;/gs))
    enums[name] = Object.fromEntries(
        [...body.matchAll(/\bLIGHTBIN_(?:RESOURCE_|CULL_)?(\w+)\s*=\s*(\d+)/g)]
            .map(([, value, number]) => [kebab(value), +number]));

const script = fs.readFileSync(user, 'utf8');
const named = name => script.includes(`'${camel(name)}'`) || script.includes(`structs.${camel(name)}.`);
const structs = {};
const sizes = {int32_t: 4, uint32_t: 4, uint64_t: 8, float: 4, double: 8, size_t: 4, pointer: 4};
for (const [, name, body] of header.matchAll(/typedef struct lightbin_(\w+) \{(.*?)\n\} lightbin_\1;/gs)) {
    const struct = structs[name] = {bytes: 0, alignment: 1, members: {}};
    // The comment after a member may say that it is "a lightbin_NAME", an enum's value, or name the values that it may
    // have.
    const declaration = /^ *(?:const )?(\w+)(\*?)\s+([^;/]+);(?: *\/\*(.*?)\*\/)?/gm;
    for (const [, type, star, names, comment] of body.matchAll(declaration))
        for (const [i, declared] of names.split(/,\s*/).entries()) {
            const [, own_star, member, , count] = declared.match(/^(\*?)(\w+)(\[(\d+)\])?$/);
            const inner = structs[bare(type)];
            const kind = own_star || (star && i === 0) ? 'pointer' : inner !== undefined ? 'struct' : type;
            const bytes = kind === 'struct' ? inner.bytes : sizes[kind];
            if (bytes === undefined && named(name)) throw new Error(`lightbin_${name}: what is ${type}?`);
            const alignment = kind === 'struct' ? inner.alignment : bytes;
            const offset = Math.ceil(struct.bytes / alignment) * alignment;
            const value_of = [comment?.match(/\ba lightbin_(\w+)/)?.[1], member].find(known => known in enums);
            const allowed = [...(comment ?? '').matchAll(/\bLIGHTBIN_(\w+)/g)].map(([, value]) => kebab(value))
                .filter(value => Object.hasOwn(enums[value_of] ?? {}, value));
            const own = `${name}_${member}`;
            if (allowed.length > 0)
                enums[own] = Object.fromEntries(allowed.map(value => [value, enums[value_of][value]]));
            const more = kind === 'struct' ? bare(type) : kind !== 'int32_t' ? undefined
                : own in enums ? own : value_of;
            struct.members[member] = [kind, offset, ...more === undefined ? [] : [more]];
            struct.bytes = offset + bytes * (count ?? 1);
            struct.alignment = Math.max(struct.alignment, alignment);
        }
    struct.bytes = Math.ceil(struct.bytes / struct.alignment) * struct.alignment;
}

// Members that the package leaves out, so that JavaScript refuses their names.
const left_out = /^unused/;

const used = new Set(Object.keys(structs).filter(named)), used_enums = new Set();
for (const name of used)  // which grows as structs in structs are found
    for (const [member, [kind, , more]] of Object.entries(structs[name].members))
        if (more !== undefined && !left_out.test(member)) (kind === 'struct' ? used : used_enums).add(more);
const entries = (names, shown) =>
    [...names].map(name => `    ${camel(name)}: ${JSON.stringify(shown(name))},\n`).join('');
fs.writeFileSync(js, `// Made by tables.mjs from lightbin.h.
export const enums = {
${entries(used_enums, name => enums[name])}};
export const structs = {
${entries(used, name => ({bytes: structs[name].bytes, members: Object.fromEntries(
    Object.entries(structs[name].members).filter(([member]) => !left_out.test(member))
        .map(([member, [kind, offset, more]]) => [camel(member), [kind, offset, ...more ? [camel(more)] : []]]))}))}};
`);
fs.writeFileSync(inl, [...used].flatMap(name => [
    `static_assert(sizeof(lightbin_${name}) == ${structs[name].bytes});`,
    ...Object.entries(structs[name].members).map(
        ([member, [, offset]]) => `static_assert(offsetof(lightbin_${name}, ${member}) == ${offset});`),
]).join('\n') + '\n');
