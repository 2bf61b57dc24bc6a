/* SPDX-License-Identifier: Apache-2.0 */
"use strict";
/* JSON for the readers in C: the browser parses it, and its values are laid out in their memory as cjson/cJSON.h has
 * them. */
const JSON_ITEM = 32, JSON_TYPES = ["false", "true", "null", "number", "string", "array", "object"];
const typeOf = (value) => (value === null ? "null" : Array.isArray(value) ? "array" : typeof value === "boolean" ? `${value}` : typeof value);

/* Returns a value and all in it, each with the indices of its first child and of its next sibling, or -1. */
function itemsOf(root) {
  const items = [{ name: null, value: root, next: -1, child: -1 }];
  for (let i = 0; i < items.length; i++) { /* which grows */
    const { value } = items[i], type = typeOf(value);
    if (type !== "array" && type !== "object") continue;
    const names = Object.keys(value);
    if (names.length > 0) items[i].child = items.length;
    names.forEach((key, n) => items.push({ name: type === "object" ? key : null, value: value[key], child: -1,
                                           next: n + 1 < names.length ? items.length + 1 : -1 }));
  }
  return items;
}

/* Returns the address of the value of a text in the module's memory; 0: it is not JSON. */
function placeJson(at, bytes) {
  let root;
  try {
    root = JSON.parse(new TextDecoder().decode(bytesAt(at, bytes)).replace(/\0+$/, ""));
  } catch {
    return 0;
  }
  const items = itemsOf(root), texts = [], coder = new TextEncoder();
  let end = items.length * JSON_ITEM;
  const textAt = (text) => {
    const coded = coder.encode(`${text}\0`), start = end;
    texts.push([start, coded]);
    end += coded.length;
    return start;
  };
  const places = items.map(({ name, value }) => ({ name: name === null ? -1 : textAt(name), text: typeof value === "string" ? textAt(value) : -1 }));
  const base = files.room(end) >>> 0;
  if (base === 0) throw new Error("out of memory");
  const view = new DataView(files.memory.buffer, base, end);
  const address = (offset) => (offset < 0 ? 0 : base + offset);
  items.forEach(({ value, next, child }, i) => {
    const item = i * JSON_ITEM, put = (offset, number) => view.setUint32(item + offset, number, true);
    put(0, address(next < 0 ? -1 : next * JSON_ITEM));
    put(4, address(child < 0 ? -1 : child * JSON_ITEM));
    put(8, JSON_TYPES.indexOf(typeOf(value)));
    put(12, address(places[i].text));
    view.setFloat64(item + 16, typeof value === "number" ? value : 0, true);
    put(24, address(places[i].name));
  });
  for (const [start, coded] of texts) bytesAt(base + start, coded.length).set(coded);
  return base;
}
