/* Forms for the selected element and for the scenario, made from the schema of scenario files. */

/** Keys that most people need; others are folded. */
const COMMON = {
  "": ["name", "description", "duration_secs", "profile", "motivation", "preferred_speed", "seed"],
  crowd: ["name", "number", "goal", "journey", "preferred_speed", "premovement_secs"],
  exit: ["most_per_sec", "closed_secs"],
  door: ["one_way", "closed_secs"],
  entrance: ["name", "per_sec", "number", "from_secs", "until_secs", "goal", "journey"],
  waypoint: ["within"],
  waiting: ["for_secs", "until_secs"],
  queue: ["servers", "spacing"],
  zone: ["name", "speed_factor", "motivation"],
  grid: ["name", "jitter", "goal", "journey"],
  source: ["name", "every_secs", "times", "goal", "journey"],
  agent: ["goal", "journey", "preferred_speed", "radius", "velocity"],
  event: ["open", "close", "release", "name"],
  measurement: ["name", "from_secs", "until_secs"],
  label: ["width"],
};
/** Keys that hold the places of an element. */
const PLACES = ["area", "line", "path", "at", "position", "min", "max", "region", "facing", "cabin"];
/** Keys of the scenario that are elements, or that only hold other keys. */
const LISTED = new Set(["$schema", "levels", "behaviour_seed", ...Object.values(KINDS).map(kind => kind.list)]);

/** One value of the document as a field. */
class Field {
  static count = 0;

  constructor(form, path, schema, isRequired) {
    Object.assign(this, { form, path, schema, isRequired });
    this.id = `field-${pathText(path).replace(/\W+/g, "-")}`;
    const { root } = form, types = root.alternatives(schema).flatMap(one => root.types(one));
    this.words = root.words(schema);
    this.isFlag = types.length === 1 && types[0] === "boolean";
    const isNumber = types.some(type => type === "number" || type === "integer");
    this.isChoice = this.words.length > 0 && !isNumber;
    this.isText = types.includes("string") && !this.words.length;
    this.isLong = !this.isFlag && !this.isChoice && types.every(type => type === "array" || type === "object");
    this.control = this.build();
    Object.assign(this.control, { id: this.id, name: pathText(path) });
    this.control.addEventListener("change", () => this.write());
    this.error = element("span", { className: "error", id: `${this.id}-error`, role: "alert" });
    const name = form.base === null ? "corners" : path.slice(form.base).join(".");
    const label = element("label", { htmlFor: this.id }, name, isRequired ? " *" : "");
    const range = this.isFlag || this.isChoice ? "" : root.range(schema);
    const about = element("small", { id: `${this.id}-about`, textContent: this.about(range) });
    this.control.setAttribute("aria-describedby", `${this.id}-about ${this.id}-error`);
    const look = { className: this.isFlag ? "field flag" : "field" };
    this.row = element("div", look, label, this.control, this.error, about);
    this.row.dataset.path = pathText(path);
    this.read();
  }

  about(range) {
    const text = root => (root.description ?? "").replaceAll("`", "");
    const isSaid = this.schema.default !== undefined && !this.isFlag && !this.isChoice;
    const said = isSaid ? ` Default: ${JSON.stringify(this.schema.default).replaceAll("\"", "")}.` : "";
    return `${text(this.schema)}${range ? ` (${range})` : ""}${said}`;
  }

  build() {
    if (this.isFlag) return element("input", { type: "checkbox" });
    if (this.isChoice) return this.buildChoice();
    const value = this.schema.default, usual = value === undefined || value === null ? "" : String(value);
    const text = usual || this.words.map(word => `or ${word}`).join(" ");
    const sample = text || this.form.root.sample(this.schema);
    if (this.isLong) return element("textarea", { rows: 2, spellcheck: false, placeholder: sample });
    const made = element("input", { type: "text", placeholder: text, autocomplete: "off", spellcheck: false });
    if (!this.isText) made.inputMode = "decimal";
    const names = this.form.namesFor(this.path.at(-1));
    if (!names) return made;
    made.setAttribute("list", names);
    return made;
  }

  buildChoice() {
    const value = this.schema.default, none = value === undefined || value === null ? "default" : `default: ${value}`;
    const made = element("select", {}, element("option", { value: "", textContent: none }));
    made.append(...this.words.map(word => element("option", { value: word, textContent: word })));
    return made;
  }

  get value() {
    return valueAt(this.form.drawing.document, this.path);
  }

  /** Shows the value of the document. */
  read() {
    const { value, control } = this;
    if (this.isFlag) {
      control.checked = value ?? this.schema.default ?? false;
      return;
    }
    if (this.isChoice) this.readChoice(value);
    else {
      const text = value === undefined || value === null ? "" : typeof value === "string" ? value : Forms.json(value);
      if (control.value !== text) control.value = text;
      if (this.isLong) control.rows = Math.min(Math.max(Math.ceil(text.length / 44), 2), 8);
    }
    this.fail(null);
  }

  /** Values that are not among the words keep an option of their own, which says so. */
  readChoice(value) {
    const { control } = this;
    control.querySelector("[data-own]")?.remove();
    const text = value === undefined || value === null ? "" : typeof value === "string" ? value : JSON.stringify(value);
    if (text && !this.words.includes(text)) {
      const own = element("option", { value: text, textContent: text.slice(0, 40) });
      own.dataset.own = "";
      control.append(own);
    }
    control.value = text;
  }

  /** Takes over what was typed, if it can be. */
  write() {
    const { value, reason } = this.meant();
    this.fail(reason);
    if (reason) return;
    const { drawing } = this.form, before = this.value, key = this.path.at(-1);
    if (JSON.stringify(before) === JSON.stringify(value)) return;
    drawing.change(document => {
      const isRenamed = key === "name" && typeof before === "string" && typeof value === "string";
      setAt(document, this.path, value);
      if (isRenamed && NAMED.includes(this.path[0])) rename(document, before, value);
      this.form.prune(document, this.path);
    });
  }

  /** The value that was typed, or why it is none. */
  meant() {
    const { control, schema } = this;
    if (this.isFlag) return { value: control.checked === (schema.default ?? false) ? undefined : control.checked };
    const text = control.value.trim();
    if (!text) return { value: undefined, reason: this.isRequired ? "this is required" : null };
    const value = this.parsed(text);
    if (value === undefined) return { reason: this.form.root.expected(schema, this.words) };
    return { value, reason: this.form.root.mismatch(schema, value) };
  }

  parsed(text) {
    if (this.isText && !/^[[{]/.test(text) || this.words.includes(text)) return text;
    try {
      return JSON.parse(text);
    } catch {
      const number = Number(text.replace(",", "."));
      return Number.isFinite(number) ? number : undefined;
    }
  }

  /** Shows why the field is wrong, or that it is not. */
  fail(reason) {
    this.error.textContent = reason ? `${this.path.at(-1)}: ${reason}` : "";
    this.control.ariaInvalid = String(Boolean(reason));
  }
}

/** The form beside the drawing. */
class Forms {
  constructor(drawing) {
    this.drawing = drawing;
    this.element = document.getElementById("draw-form");
    this.fields = [];
    this.folds = [];
    /** The folded parts that are open, so that those of the next element are, too. */
    this.open = new Set();
    ask("schema").then(schema => {
      this.root = new Schema(schema);
      this.show();
    }, error => drawing.studio.say(drawing.studio.words(error), "wrong"));
  }

  /** A value as JSON that is easy to read. */
  static json(value) {
    // Line breaks within texts are escaped: these are between values.
    return JSON.stringify(value, null, 1).replace(/,\n */g, ", ").replace(/\n */g, "");
  }

  /** Shows the form of what is selected; fields that are there show their values again. */
  show() {
    if (!this.root) return;
    const { selected, document: own } = this.drawing, text = selected?.text ?? "";
    this.showNames();
    if (text === this.text && this.keys === this.keysOf(selected)) {
      const isHere = field => field.control === document.activeElement && field.control.ariaInvalid === "true";
      for (const field of this.fields) if (!isHere(field)) field.read();
      this.title.textContent = selected?.name ?? "Scenario";
      return;
    }
    [this.text, this.keys] = [text, this.keysOf(selected)];
    this.fields = [];
    /** The parts that are made when they are opened. */
    this.folds = [];
    /** How many keys of a path lead to the element itself; `null`: it has no keys. */
    this.base = !selected ? 0 : Array.isArray(selected.element) ? null : selected.path.length;
    this.element.replaceChildren(...selected ? this.partsOfElement(selected) : this.partsOfScenario(own));
    this.showProblem();
  }

  /** What decides about the fields of an element. */
  keysOf(selected) {
    return selected ? `${selected.kind} ${Array.isArray(selected.element)}` : "";
  }

  /** Lists of names that fields offer. */
  namesFor(key) {
    const lists = { journey: "journeys", open: "doors", close: "doors", release: "areas", level: "levels" };
    return lists[key] && `names-${lists[key]}`;
  }

  showNames() {
    const { document: own } = this.drawing, names = list => (own[list] ?? []).map?.(({ name }) => name) ?? [];
    const all = {
      "names-journeys": names("journeys"), "names-doors": [...names("exits"), ...names("doors"), ...names("entrances")],
      "names-areas": names("waiting_areas"), "names-levels": names("levels"),
    };
    for (const [id, list] of Object.entries(all)) {
      const place = document.getElementById(id) ?? element("datalist", { id });
      if (!place.isConnected) document.body.append(place);
      place.replaceChildren(...list.map(value => element("option", { value })));
    }
  }

  heading(text, ...more) {
    this.title = element("span", { textContent: text });
    return element("h2", {}, this.title, ...more);
  }

  partsOfElement(shape) {
    const remove = element("button", { id: "draw-remove", textContent: "Delete", title: "delete this element (Del)" });
    remove.addEventListener("click", () => {
      this.drawing.corner = null;
      this.drawing.remove();
    });
    const title = "settings of the scenario (Esc)";
    const close = element("button", { id: "draw-unselect", textContent: "×", title });
    close.ariaLabel = "settings of the scenario";
    close.addEventListener("click", () => this.drawing.select(null));
    const about = element("p", { className: "soft", textContent: this.measures(shape) });
    const head = [this.heading(shape.name, element("span", { className: "buttons" }, remove, close)), about];
    const schema = this.root.at(shape.path);
    if (!schema.properties) {
      return [...head, this.field(shape.path, schema, true).row];
    }
    return [...head, ...this.groups(shape.path, schema, COMMON[shape.kind] ?? [])];
  }

  /** The size of an element in words. */
  measures(shape) {
    const [first] = shape.strokes, { heading } = shape;
    if (!first) return heading;
    const { points, isClosed } = first;
    if (isClosed) return `${heading}: ${shown(shape.area, 2)} m²`;
    if (points.length === 1) return `${heading}: at ${points[0].map(x => shown(x, 2)).join(", ")} m`;
    const length = points.slice(1).reduce((sum, end, k) => sum + distance(points[k], end), 0);
    return `${heading}: ${shown(length, 2)} m`;
  }

  partsOfScenario() {
    const schema = this.root.of(this.root.root);
    const own = Object.fromEntries(Object.entries(schema.properties).filter(([key]) => !LISTED.has(key)));
    delete own.goal;
    const hint = element("p", { className: "soft", textContent: "Select an element to change it." });
    return [this.heading("Scenario"), hint, ...this.groups([], { ...schema, properties: own }, COMMON[""])];
  }

  /** Required fields, common ones, and all others, which are folded. */
  groups(path, { properties, required = [] }, common) {
    const keys = Object.keys(properties), isPlace = key => PLACES.includes(key);
    const wanted = new Set([...required.filter(key => !isPlace(key)), ...common]);
    const first = [...wanted].filter(key => properties[key]);
    const places = keys.filter(isPlace), others = keys.filter(key => !first.includes(key) && !isPlace(key));
    const rows = list => list.map(key => this.part([...path, key], properties[key], required.includes(key)));
    const made = rows(first);
    if (path.length === 0) made.push(...this.stop());
    if (places.length) made.push(this.folded(path, "Corners and places", () => rows(places)));
    const rest = others.filter(key => path.length || key !== "stop");
    if (rest.length) made.push(this.folded(path, "All other settings", () => rows(rest)));
    return made;
  }

  /** The keys of `stop`, which most scenarios need. */
  stop() {
    return [this.part(["stop", "when_empty"], this.root.at(["stop", "when_empty"]), false),
      this.part(["stop", "idle_secs"], this.root.at(["stop", "idle_secs"]), false)];
  }

  /** Parts that are made when they are opened. */
  folded(path, title, make) {
    const key = `${this.drawing.selected?.kind ?? ""} ${title} ${path.length}`;
    const made = element("details", { open: this.open.has(key) }, element("summary", { textContent: title }));
    const fill = () => {
      if (made.childElementCount === 1) made.append(...make());
    };
    this.folds.push({ fill });
    if (made.open) fill();
    made.addEventListener("toggle", () => {
      this.open[made.open ? "add" : "delete"](key);
      if (made.open) fill();
    });
    return made;
  }

  /** A field, or the fields of an object. */
  part(path, schema, isRequired) {
    const alternatives = this.root.alternatives(schema), [only] = alternatives, own = this.root.of(schema);
    const isObject = alternatives.length === 1 && only.properties && Object.keys(only.properties).length;
    if (!isObject) return this.field(path, own, isRequired).row;
    return this.folded(path, path.at(-1), () => {
      const keys = Object.keys(only.properties);
      const about = element("p", { className: "soft", textContent: (own.description ?? "").replaceAll("`", "") });
      return [about, ...keys.map(key => this.part([...path, key], only.properties[key], false))];
    });
  }

  field(path, schema, isRequired) {
    const made = new Field(this, path, schema, isRequired);
    this.fields.push(made);
    return made;
  }

  /** Removes objects that have lost their last key. */
  prune(document, path) {
    for (let length = path.length - 1; length > 0; length--) {
      const inner = path.slice(0, length), value = valueAt(document, inner);
      const isElement = typeof path[length] === "string" && typeof inner.at(-1) === "number";
      const isEmpty = value && typeof value === "object" && !Array.isArray(value) && !Object.keys(value).length;
      if (!isEmpty || isElement || inner.includes("measurements")) return;
      setAt(document, inner, undefined);
    }
  }

  /** Marks the field in which the problem of the drawing lies; whether there is one. */
  showProblem(isFocused = false) {
    const { problem } = this.drawing;
    const isIn = path => problem && [path, `${path}[`, `${path}.`].some((start, k) => k ? problem.path.startsWith(start)
      : problem.path === start);
    const found = () => this.fields.find(field => isIn(pathText(field.path)));
    let wrong = found();
    // The loop also comes to those that are within others.
    if (isFocused && problem && !wrong) for (const fold of this.folds) fold.fill();
    wrong ??= found();
    for (let place = wrong?.row; place && isFocused; place = place.parentElement.closest("details")) place.open = true;
    for (const field of this.fields) field.row.classList.toggle("wrong", field === wrong);
    if (isFocused) wrong?.control.focus();
    return Boolean(wrong);
  }

  /** Puts the focus into the first field. */
  focus() {
    this.fields[0]?.control.focus();
  }
}
