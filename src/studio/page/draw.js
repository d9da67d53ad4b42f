/* The drawing: the document, its history, what is selected, and the checks by the program. */

class Drawing {
  /** The most steps that can be undone. */
  static MOST_STEPS = 200;
  /** The time after a change until the program checks the drawing, milliseconds. */
  static CHECKING = 300;
  static STORED = "studio.drawing";
  /** The most characters that a page which is closed can still send. */
  static LAST = 60_000;
  /** Changes of the same thing within this time are one step of the history, milliseconds. */
  static JOINING = 1000;
  /** People of the default size that surely find room, per square meter. */
  static FIT = 2.5;
  /** A place in the reason of a problem. */
  static PLACE = /\((-?[\d.]+(?:e-?\d+)?), (-?[\d.]+(?:e-?\d+)?)\)/;
  /** The key path of an element in a message, and the dot before a key in it. */
  static KEYS = /((?:\blevels\[\d+\]\.)?\b[a-z_]+\[\d+\])(\.(?=[a-z]))?/g;

  constructor(studio) {
    this.studio = studio;
    this.document = {};
    this.shapes = [];
    this.shown = [];
    this.version = 0;
    this.level = null;
    this.selected = this.corner = this.problem = null;
    this.undone = [];
    this.done = [];
    this.copied = null;
    this.sheet = new Sheet(this);
    this.snapping = new Snapping(this);
    this.draft = new Draft(this);
    this.underlay = new Underlay(this);
    this.elements = new Elements(this);
    this.form = new Forms(this);
    this.hand = new Hand(this);
    const on = (id, does) => document.getElementById(id).addEventListener("click", does);
    on("draw-undo", () => this.undo());
    on("draw-redo", () => this.redo());
    on("draw-play", () => this.play());
    on("draw-problem", () => this.showProblem());
    addEventListener("pagehide", () => this.leave());
    document.getElementById("draw-level").addEventListener("change", event => this.chooseLevel(event.target.value));
    this.draft.choose("select", true);
  }

  /* The document. */

  /**
   * Draws another document; undoing brings the one before back. The program keeps it by `key` from its first change on,
   * or at once if it `isChanged`.
   */
  open(document, { key = crypto.randomUUID(), isChanged = false } = {}) {
    this.leave();
    if (this.shapes.length) this.keep(JSON.stringify(this.document));
    Object.assign(this, { document, key, isChanged });
    this.token = null;
    this.level = document.levels?.[0]?.name ?? null;
    this.select(null);
    this.problem = null;
    this.refresh();
    this.sheet.fit();
    this.draft.choose(this.shapes.length ? "select" : "room");
  }

  /** Changes the document; changes with the same `token` one soon after the other are undone together. */
  change(does, token = null) {
    const before = JSON.stringify(this.document), now = performance.now();
    does(this.document);
    const isJoined = token !== null && token === this.token && now - this.changed < Drawing.JOINING;
    [this.token, this.changed, this.isChanged] = [token, now, true];
    if (!isJoined) this.keep(before);
    this.sheet.isWhole = false;
    this.studio.say("");
    this.refresh();
  }

  /** Keeps a state of the document in the history. */
  keep(before) {
    this.done.push(before);
    if (this.done.length > Drawing.MOST_STEPS) this.done.shift();
    this.undone = [];
  }

  undo() {
    this.restore(this.done, this.undone);
  }

  redo() {
    this.restore(this.undone, this.done);
  }

  restore(from, to) {
    if (!from.length) return;
    to.push(JSON.stringify(this.document));
    this.document = JSON.parse(from.pop());
    [this.token, this.isChanged] = [null, true];
    this.refresh();
  }

  /** Takes over a change of the document. */
  refresh() {
    this.read();
    this.elements.show();
    this.form.show();
    this.studio.showName();
    document.getElementById("draw-undo").disabled = !this.done.length;
    document.getElementById("draw-redo").disabled = !this.undone.length;
    this.showLevels();
    this.store();
    clearTimeout(this.checking);
    this.checking = setTimeout(() => this.check(), Drawing.CHECKING);
    this.showAll();
  }

  /** Finds the elements of the document again; the one with the path of the selected one stays selected. */
  read() {
    this.version++;
    this.shapes = shapesOf(this.document);
    this.shown = this.shapes.filter(shape => shape.isOn(this.level));
    this.selected = this.shapes.find(shape => shape.text === this.selected?.text) ?? null;
    if (!this.selected) this.corner = null;
  }

  /** Keeps the document for a reload of the page. */
  store() {
    const { document, key, isChanged } = this;
    try {
      sessionStorage.setItem(Drawing.STORED, JSON.stringify({ document, key, isChanged }));
    } catch {
      // The program keeps it, too.
    }
  }

  /** Opens what was drawn in this tab before its page was loaded again; whether there is something. */
  restoreStored() {
    let stored = null;
    try {
      stored = JSON.parse(sessionStorage.getItem(Drawing.STORED));
    } catch {
      return false;
    }
    if (!stored) return false;
    // A copy of a tab is another drawing.
    const isReload = performance.getEntriesByType("navigation")[0]?.type === "reload";
    this.open(stored.document, { isChanged: stored.isChanged, ...isReload ? { key: stored.key } : {} });
    return true;
  }

  /* Elements. */

  /** Adds the element that a tool made of points. */
  add(tool, points) {
    const { document } = this, field = id => Number(globalThis.document.getElementById(id).value);
    const thickness = Math.min(Math.max(field("draw-thickness") || 0, 0), 10);
    const { number, isLess } = this.numberIn(points);
    const [list, made] = PENCILS[tool].make(points, { document, thickness, number });
    let path = [list];
    this.change(document => {
      if (list === "goal") {
        document.goal = made;
        return;
      }
      if (list === "doors") made.line = this.cut(made.line);
      const isFloor = ["walkable_area", "obstacles"].includes(list);
      if (this.level && !isFloor) (list === "measurements" ? Object.values(made)[0] : made).level = this.level;
      const level = this.levelAt;
      const owner = level >= 0 && isFloor ? ["levels", level, list] : [list];
      const elements = valueAt(document, owner) ?? [];
      elements.push(made);
      setAt(document, owner, elements);
      path = [...owner, elements.length - 1, ...list === "measurements" ? [Object.keys(made)[0]] : []];
    });
    this.select(pathText(path));
    if (!PENCILS[tool].stays) this.draft.choose("select");
    const find = number === 1 ? "1 person finds" : `${number} people find`;
    if (list === "crowds" && isLess) this.say(`${find} room here; type another number in the form.`);
  }

  /** The number of the level that is drawn, or -1. */
  get levelAt() {
    return (this.document.levels ?? []).findIndex?.(level => level.name === this.level) ?? -1;
  }

  /** The number of people that was typed; without one, the default, or less where fewer find room. */
  numberIn(area) {
    const { value, defaultValue } = document.getElementById("draw-number");
    const typed = Math.round(Number(value)), usual = Number(defaultValue);
    if (typed >= 1 && value !== defaultValue) return { number: typed, isLess: false };
    const most = Math.max(Math.floor(Drawing.FIT * Math.abs(twiceArea(area)) / 2), 1);
    return { number: Math.min(usual, most), isLess: most < usual };
  }

  /** Opens the straight wall along which a door lies; the line of the door, in its middle. */
  cut(line) {
    const level = this.levelAt, path = level >= 0 ? ["levels", level, "obstacles"] : ["obstacles"];
    const walls = valueAt(this.document, path);
    if (!Array.isArray(walls)) return line;
    for (const [k, wall] of walls.entries()) {
      const found = opening(wall, line, 2 * Snapping.EDGE / this.sheet.scale);
      if (!found) continue;
      walls.splice(k, 1, ...found.walls);
      return found.line;
    }
    return line;
  }

  select(text) {
    const before = this.selected;
    this.selected = this.shapes.find(shape => shape.text === text) ?? null;
    if (this.selected && !this.selected.isOn(this.level)) this.chooseLevel(this.selected.levels[0]);
    if (before?.text !== this.selected?.text) this.corner = null;
    this.elements?.show();
    this.form?.show();
    this.showAll();
  }

  /** Removes the selected element, or its chosen corner. */
  remove() {
    const { selected, corner } = this;
    if (!selected) return;
    const stroke = corner && selected.strokes.find(({ path }) => pathText(path) === corner.path);
    if (stroke?.grows && stroke.points.length > stroke.least) {
      this.change(() => stroke.points.splice(corner.at, 1));
      this.corner = null;
      this.showAll();
      return;
    }
    this.change(document => {
      setAt(document, selected.whole, undefined);
      const [list] = selected.whole;
      if (Array.isArray(document[list]) && !document[list].length) delete document[list];
    });
    this.select(null);
  }

  copy() {
    const { selected } = this;
    if (!selected || !selected.list) return;
    const element = structuredClone(valueAt(this.document, selected.whole));
    this.copied = { list: selected.whole.slice(0, -1), element };
    this.say(`${selected.name} is copied; Ctrl+V adds it.`);
  }

  /** Adds what was copied, beside where it was. */
  paste() {
    if (!this.copied) return;
    const { list, element } = structuredClone(this.copied), at = valueAt(this.document, list)?.length ?? 0;
    if (element.name) element.name = newName(this.document, element.name.replace(/ \d+$/, ""));
    this.change(document => {
      setAt(document, list, [...valueAt(document, list) ?? [], element]);
      const inner = list[0] === "measurements" ? [Object.keys(element)[0]] : [];
      this.select(null);
      this.read();
      const made = this.shapes.find(shape => shape.text === pathText([...list, at, ...inner]));
      made?.moveFrom(made.places.map(place => [...place]), [2 * this.sheet.step, -2 * this.sheet.step]);
      this.selected = made ?? null;
    });
    this.copied = { list, element: structuredClone(element) };
  }

  duplicate() {
    const { copied } = this;
    this.copy();
    this.paste();
    this.copied = copied ?? this.copied;
  }

  /** Moves the selected element, or its chosen corner, by steps of the grid. */
  nudge(way, count) {
    const { selected, corner, sheet } = this, by = way.map(x => x * count * sheet.step);
    if (!selected) {
      sheet.moveBy(-way[0] * 40, way[1] * 40);
      return;
    }
    const stroke = corner && selected.strokes.find(({ path }) => pathText(path) === corner.path);
    this.change(() => {
      if (stroke) selected.grip(stroke, corner.at)(stroke.points[corner.at].map((x, axis) => clean(x + by[axis])));
      else selected.moveFrom(selected.places.map(place => [...place]), by);
    }, `nudge ${selected.text} ${corner?.path} ${corner?.at}`);
  }

  /** Chooses the next corner of the selected element, for the keys. */
  nextCorner() {
    const corners = (this.selected?.strokes ?? [])
      .flatMap(({ path, points }) => points.map((_, at) => ({ path: pathText(path), at })));
    const isSame = ({ path, at }) => path === this.corner?.path && at === this.corner?.at;
    this.corner = corners[corners.findIndex(isSame) + 1] ?? null;
    this.showAll();
  }

  get selectedHint() {
    const { corner, selected } = this;
    if (!selected.strokes.length) return `${selected.name}: its settings are beside the drawing.`;
    const part = corner ? "this corner" : "it";
    const moves = `drag or arrow keys move ${part}, Delete removes ${part}`;
    const grows = selected.strokes.some(stroke => stroke.grows) ? " Double click on an edge: another corner." : "";
    return `${selected.name}: ${moves}. Enter: next corner.${grows} Ctrl+D copies.`;
  }

  /* Checks. */

  /** Asks the program for the first problem of the drawing, and shows it. */
  async check() {
    const { version } = this;
    let found;
    try {
      found = await ask(this.checks, this.document);
    } catch (error) {
      found = { problem: { path: error.path ?? "", message: this.studio.words(error) }, notes: [] };
    }
    if (version !== this.version) return;
    this.checked = version;
    this.showFound(found);
  }

  /** The request that checks the drawing; once it was changed, the program keeps it. */
  get checks() {
    return this.isChanged ? `check?drawing=${this.key}` : "check";
  }

  /** Sends the last change, when the page is closed or another drawing is opened before it was checked. */
  leave() {
    const body = JSON.stringify(this.document);
    if (!this.isChanged || this.checked === this.version) return;
    answerOf(this.checks, { method: "POST", body, keepalive: body.length < Drawing.LAST }).catch(() => null);
  }

  showFound({ problem, notes, people }) {
    this.problem = problem && { ...problem, reason: problem.reason && this.named(problem.reason) };
    const line = document.getElementById("draw-problem"), named = notes.map(note => this.named(note));
    line.classList.toggle("wrong", Boolean(problem));
    line.classList.toggle("noted", !problem && notes.length > 0);
    const count = Number.isFinite(people) ? `, ${people} ${people === 1 ? "person" : "people"} at the start` : "";
    const more = notes.length > 1 ? `, and ${notes.length - 1} more below` : "";
    const noted = notes.length ? ` Note: ${named[0]}${more}.` : "";
    line.textContent = this.shapes.length || problem ? this.problemText ?? `Ready to play${count}.${noted}` : "";
    document.getElementById("draw-notes").replaceChildren(...named.map(text => element("li", { textContent: text })));
    const list = document.getElementById("draw-noted");
    list.hidden = !notes.length;
    list.firstElementChild.textContent = `Notes (${notes.length})`;
    this.elements.show();
    this.form.showProblem();
    this.sheet.show();
  }

  /** A message with the names of elements in place of key paths such as `doors[0]`. */
  named(text) {
    const named = path => this.shapes.find(({ whole }) => pathText(whole) === path)?.name;
    return text.replace(Drawing.KEYS, (all, path, dot) => named(path) ? `${named(path)}${dot ? ", " : ""}` : all);
  }

  /** The problem in words: the element, or else the key path, and the reason. */
  get problemText() {
    if (!this.problem?.reason) return this.problem?.message;
    const { wrong, problem: { path, reason } } = this;
    const place = wrong && pathKeys(path).length >= wrong.whole.length ? wrong.name : path;
    return place ? `${place}: ${reason}` : reason;
  }

  /** The place that the reason of the problem names. */
  get wrongPlace() {
    return Drawing.PLACE.exec(this.problem?.reason)?.slice(1).map(Number) ?? null;
  }

  /** The element in which the problem lies. */
  get wrong() {
    if (!this.problem?.path) return null;
    const keys = pathKeys(this.problem.path);
    const holds = ({ path }) => path.every((key, k) => key === keys[k]);
    // A problem of a list as a whole stands at its first element.
    const isOf = ({ path }) => keys.every((key, k) => key === path[k]);
    return this.shapes.find(holds) ?? this.shapes.find(isOf) ?? null;
  }

  /** Selects the element with the problem. */
  showProblem() {
    if (!this.problem) return;
    const { wrong, wrongPlace } = this;
    this.select(wrong?.text ?? null);
    if (wrongPlace) this.sheet.reveal(wrongPlace);
    else if (wrong?.strokes.length) this.sheet.reveal(wrong.middle);
    if (!this.form.showProblem(true)) this.elements.focus(wrong);
  }

  /** The message beside the place or the element with the problem. */
  showMark() {
    const mark = document.getElementById("draw-mark"), { wrong, wrongPlace, sheet } = this;
    for (const own of sheet.world.children) own.classList.toggle("wrong", own.dataset.path === wrong?.text);
    const points = wrongPlace ? [wrongPlace] : wrong?.strokes[0]?.points;
    mark.hidden = !points || wrong?.strokes.length > 0 && !this.shown.includes(wrong);
    if (mark.hidden) return;
    mark.textContent = this.problem.reason ?? this.problem.message;
    const [low, high] = extent(points), [x, y] = sheet.toSheet(high), [, bottom] = sheet.toSheet(low);
    const left = Math.min(Math.max(x + 10, 6), sheet.width - mark.offsetWidth - 52);
    mark.style.left = `${Math.max(left, 6)}px`;
    const above = y - mark.offsetHeight - 8, lowest = sheet.height - mark.offsetHeight - 40;
    mark.style.top = `${Math.max(Math.min(above > 6 ? above : bottom + 8, lowest), 6)}px`;
  }

  /** Plays the drawing, at once or stopped in its first frame, or leads to its problem; whether it can be played. */
  async play(isPlaying = true) {
    try {
      await this.studio.play(this.document, isPlaying);
      return true;
    } catch (error) {
      if (this.studio.mode !== "draw") this.studio.open("draw");
      const problem = { path: error.path ?? "", reason: error.reason, message: this.studio.words(error) };
      this.showFound({ problem, notes: [] });
      this.showProblem();
      return false;
    }
  }

  /* What is shown. */

  showAll() {
    this.say(this.draft.hint);
    this.sheet.show();
  }

  /** Shows a hint; what finds no room in its line, too, when the pointer rests on it. */
  say(text) {
    const hint = document.getElementById("draw-hint");
    [hint.textContent, hint.title] = [text, text];
  }

  tellPlace([x, y]) {
    document.getElementById("draw-place").textContent = `${shown(x, 3)}, ${shown(y, 3)} m`;
  }

  /** What to do next, until there is a floor, a way out and people. */
  get nextHint() {
    const { document: own } = this, has = list => own[list]?.length;
    if (!this.shapes.some(shape => shape.strokes.length)) return "Draw a room: press R or click Room, then drag.";
    const leads = own.levels || own.periodic || own.goal || has("exits");
    if (has("walkable_area") && !leads) return "Now draw an exit: press E, then drag along a wall of the room.";
    const isEmpty = !own.from && !["crowds", "grids", "sources", "agents", "entrances"].some(has);
    return isEmpty ? "Now draw a crowd: press C, then drag in the room." : "";
  }

  /** Shows what to do next, unless something is drawn right now or lies beneath, to be traced. */
  showEmpty() {
    const empty = document.getElementById("draw-empty");
    empty.textContent = this.draft.isBegun || this.underlay.image ? "" : this.nextHint;
    empty.hidden = !empty.textContent;
    empty.classList.toggle("first", !this.shapes.some(shape => shape.strokes.length));
  }

  showLevels() {
    const levels = Array.isArray(this.document.levels) ? this.document.levels : [];
    document.getElementById("draw-leveled").hidden = !levels.length;
    if (!levels.some(level => level.name === this.level)) this.level = levels[0]?.name ?? null;
    const option = ({ name }) => element("option", { value: name, textContent: name, selected: name === this.level });
    const options = levels.map(option);
    document.getElementById("draw-level").replaceChildren(...options);
  }

  chooseLevel(name) {
    this.level = name;
    this.read();
    this.showLevels();
    this.elements.show();
    this.sheet.fit();
  }

  /** A place in pixels of the window, and the scale in pixels per meter. */
  toScreen(place) {
    return this.sheet.toScreen(place);
  }

  get scale() {
    return this.sheet.scale;
  }
}
