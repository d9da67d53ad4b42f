/* The schema of scenario files: what values can be, in words. */

/** Numbers as ranges are written. */
function bound(value) {
  return Math.abs(value) >= 1e6 || value !== 0 && Math.abs(value) < 1e-4
    ? value.toExponential().replace("e+", "e") : String(value);
}

/** What is in the schema, behind its references and alternatives. */
class Schema {
  constructor(root) {
    this.root = root;
  }

  /** A schema with its reference resolved; keys beside the reference count first. */
  of(schema) {
    if (!schema?.$ref) return schema ?? {};
    const { $ref, ...own } = schema;
    return { ...this.of(valueAt(this.root, $ref.slice(2).split("/"))), ...own };
  }

  /** The alternatives of a schema, without `null`. */
  alternatives(schema) {
    const { anyOf, oneOf, ...own } = this.of(schema);
    const all = (anyOf ?? (oneOf?.some(one => one.const !== undefined || one.type) ? oneOf : null) ?? [own])
      .map(one => this.of(one));
    const flat = all.flatMap(one => one.anyOf ? this.alternatives(one) : [one]);
    return flat.filter(({ type }) => type !== "null");
  }

  /** The types of one alternative. */
  types({ type }) {
    return [type].flat().filter(one => one && one !== "null");
  }

  /** The words that a value can be, or nothing. */
  words(schema) {
    const words = this.alternatives(schema).flatMap(one => one.enum ?? (one.const === undefined ? [] : [one.const]));
    return words.filter(word => typeof word === "string");
  }

  /** The schema of the values of an element, by its path in the document. */
  at(path) {
    let found = this.of(this.root);
    for (const key of path) {
      const alternatives = this.alternatives(found);
      const inner = alternatives.map(one => typeof key === "number" ? one.items : one.properties?.[key]);
      found = this.of(inner.find(Boolean));
    }
    return found;
  }

  /** How a value is written as JSON, for lists and objects. */
  sample(schema) {
    const [{ items, maxItems, properties } = {}] = this.alternatives(schema);
    if (!items) return properties ? "{…}" : "JSON";
    const [{ type, items: inner } = {}] = this.alternatives(items);
    const one = inner ? this.sample(items) : { number: "1", integer: "1", string: "\"name\"" }[type] ?? "{…}";
    return `[${maxItems === 2 ? `${one}, ${one}` : `${one}, …`}]`;
  }

  /** The range of a value in words. */
  range(schema) {
    const texts = this.alternatives(schema).map(one => {
      const whole = this.types(one).includes("integer") ? "a whole number" : "";
      const low = one.exclusiveMinimum !== undefined ? `above ${bound(one.exclusiveMinimum)}`
        : one.minimum !== undefined ? `at least ${bound(one.minimum)}` : "";
      const most = one.maximum ?? null, isPlain = whole && most >= 4294967295;
      const high = most === null || isPlain ? "" : `at most ${bound(most)}`;
      const range = [low, high].filter(Boolean).join(" and ");
      return [whole, range].filter(Boolean).join(", ");
    });
    return [...new Set(texts.filter(Boolean))].join(", or ");
  }

  /** Why a value is not what a schema asks for, or nothing. */
  mismatch(schema, value) {
    const reasons = this.alternatives(schema).map(one => this.mismatchOf(one, value));
    if (reasons.length === 0 || reasons.includes(null)) return null;
    const words = this.words(schema), range = this.range(schema);
    if (typeof value === "number" && range) return `must be ${range}`;
    return reasons.find(reason => reason !== "type") ?? this.expected(schema, words);
  }

  expected(schema, words) {
    const types = new Set(this.alternatives(schema).flatMap(one => this.types(one)));
    const names = {
      number: "a number", integer: "a whole number", boolean: "true or false", array: "a list such as [1, 2]",
      object: "an object such as {\"uniform\": [1, 2]}",
    };
    const all = [...types].map(type => names[type]).filter(Boolean);
    return `give ${[...words, ...all].join(", or ") || "a text"}`;
  }

  mismatchOf(one, value) {
    if (one.enum) return one.enum.includes(value) ? null : "type";
    if (one.const !== undefined) return one.const === value ? null : "type";
    const types = this.types(one);
    const isType = {
      integer: Number.isInteger(value), number: typeof value === "number", string: typeof value === "string",
      boolean: typeof value === "boolean", array: Array.isArray(value),
      object: value !== null && typeof value === "object" && !Array.isArray(value),
    };
    if (types.length && !types.some(type => isType[type])) return "type";
    const { minimum = -Infinity, maximum = Infinity, exclusiveMinimum: above = -Infinity } = one;
    if (typeof value === "number") return value >= minimum && value <= maximum && value > above ? null : "range";
    if (typeof value === "string") return value.length >= (one.minLength ?? 0) ? null : "must not be empty";
    if (Array.isArray(value)) return this.mismatchOfList(one, value);
    return typeof value === "object" ? this.mismatchOfObject(one, value) : null;
  }

  mismatchOfList(one, list) {
    const { minItems = 0, maxItems = Infinity, items } = one;
    if (list.length < minItems || list.length > maxItems) {
      return minItems === maxItems ? `must have ${minItems} elements` : `must have at least ${minItems} elements`;
    }
    for (const [k, value] of list.entries()) {
      const reason = items && this.mismatch(items, value);
      if (reason) return `element ${k + 1}: ${reason}`;
    }
    return null;
  }

  mismatchOfObject(one, object) {
    const { properties = {}, required = [], additionalProperties: others } = one;
    const missing = required.find(key => object[key] === undefined);
    if (missing) return `the key ${missing} is missing`;
    for (const [key, value] of Object.entries(object)) {
      if (!properties[key] && others === false) return `unknown key ${key}`;
      const reason = properties[key] && this.mismatch(properties[key], value);
      if (reason) return `${key}: ${reason}`;
    }
    return null;
  }
}
