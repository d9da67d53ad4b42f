/* What is being drawn: the tools, their points, snapping, and typed lengths. */

/** The tools: key, words, how points make an element, and what to do, in words. */
const PENCILS = {
  select: {
    key: "v", title: "Select", hint: "Click an element to select it. Drag moves it, or its corners; Delete removes it.",
  },
  room: {
    key: "r", title: "Room", form: "box", hint: "Drag a rectangle of floor, or click two corners.",
    make: ring => ["walkable_area", [ring]],
  },
  floor: {
    key: "f", title: "Floor", form: "area", hint: "Click the corners of the floor.",
    make: ring => ["walkable_area", [ring]],
  },
  wall: {
    key: "w", title: "Wall", form: "line", stays: true, hint: "Drag a wall from end to end, or click both ends.",
    make: ([a, b], { thickness }) => ["obstacles", thickness > 0 ? wallAround(a, b, thickness) : [a, b]],
  },
  obstacle: {
    key: "o", title: "Obstacle", form: "area", hint: "Drag a rectangle, or click the corners of a solid body.",
    make: ring => ["obstacles", ring],
  },
  door: {
    key: "d", title: "Door", form: "line", hint: "Drag along a wall, which then opens, or across an opening.",
    make: (line, { document }) => ["doors", { name: newName(document, "door"), line }],
  },
  barrier: {
    key: "b", title: "Barrier", form: "line", hint: "Drag from wall to wall: nobody passes until it is opened in Play.",
    make: (line, { document }) => ["doors", { name: newName(document, "barrier"), line, closed_secs: [[0, 1e7]] }],
  },
  exit: {
    key: "e", title: "Exit", form: "line", hint: "Drag along the edge of the floor, where people leave.",
    make: (line, { document }) => ["exits", { name: newName(document, "exit"), line }],
  },
  entrance: {
    key: "n", title: "Entrance", form: "line", hint: "Drag along the edge of the floor, where people come in.",
    make: (line, { document }) => ["entrances", { name: newName(document, "entrance"), line, per_sec: 1 }],
  },
  crowd: {
    key: "c", title: "Crowd", form: "area", hint: "Drag a rectangle, or click the corners, where people stand.",
    make: (area, { document, number }) => ["crowds", { name: newName(document, "crowd"), area, number }],
  },
  agent: {
    key: "i", title: "Person", form: "point", stays: true, hint: "Click where a person stands.",
    make: ([position]) => ["agents", { position }],
  },
  waypoint: {
    key: "p", title: "Waypoint", form: "spot", hint: "Click a place on the route, or drag a line across it.",
    make: ([at, end], { document }) =>
      ["waypoints", { name: newName(document, "waypoint"), ...end ? { line: [at, end] } : { at } }],
  },
  waiting: {
    key: "a", title: "Waiting area", form: "area", hint: "Drag a rectangle, or click the corners of the area.",
    make: (area, { document }) => ["waiting_areas", { name: newName(document, "waiting area"), area, for_secs: 30 }],
  },
  queue: {
    key: "q", title: "Queue", form: "path", hint: "Drag or click the line on which people stand, from the front.",
    make: (path, { document }) => ["queues", { name: newName(document, "queue"), path, service_secs: 5 }],
  },
  zone: {
    key: "z", title: "Zone", form: "area", hint: "Drag a rectangle, or click the corners, where people walk slower.",
    make: (area, { document }) => ["zones", { name: newName(document, "zone"), area, speed_factor: 0.5 }],
  },
  region: {
    key: "m", title: "Measured region", form: "box", hint: "Drag a rectangle in which density and speed are measured.",
    make: ring => ["measurements", { walks: { region: [ring[0], ring[2]] } }],
  },
  line: {
    key: "l", title: "Measured line", form: "line", hint: "Drag a line at which the flow is measured.",
    make: line => ["measurements", { line_flow: { line } }],
  },
  label: {
    key: "t", title: "Label", form: "point", hint: "Click the place of a text.",
    make: ([at]) => ["labels", { text: "label", at }],
  },
  goal: {
    key: "g", title: "Goal", form: "point", hint: "Click where people without a goal of their own walk to.",
    make: ([goal]) => ["goal", goal],
  },
};

/** Where a place snaps to: corners, edges, then the grid; right angles first. */
class Snapping {
  /** Corners and edges within these distances attract, pixels. */
  static CORNER = 10;
  static EDGE = 9;

  constructor(drawing) {
    this.drawing = drawing;
  }

  /** The distance of the lines that attract, meters: images have finer corners than the grid that is shown. */
  get step() {
    const { sheet, underlay } = this.drawing;
    return underlay.image ? clean(sheet.step / 10) : sheet.step;
  }

  /** The place that is meant, and what it lies on. `from` has the corners before it, and `skip` is left out. */
  at(place, { isFree = false, isSquare = false, from = [], skip = null } = {}) {
    const { step, drawing: { sheet } } = this;
    const strokes = this.drawing.shown.filter(shape => shape !== skip).flatMap(shape => shape.strokes);
    if (isFree) return { place: place.map(toThousandths), on: null };
    if (isSquare && from.length) return { place: this.square(place, from), on: "square" };
    const corners = [...strokes.flatMap(stroke => stroke.points), ...from];
    const corner = this.nearest(corners, place, Snapping.CORNER / sheet.scale);
    if (corner) return { place: [...corner], on: "corner" };
    const round = place.map(x => clean(Math.round(x / step) * step));
    const edges = strokes.flatMap(({ points, isClosed }) => points.slice(isClosed ? 0 : 1)
      .map((end, k) => isClosed ? [end, points[(k + 1) % points.length]] : [points[k], end]));
    const near = this.nearest(edges.map(([a, b]) => nearestOn(a, b, place)), place, Snapping.EDGE / sheet.scale);
    if (!near) return { place: round, on: null };
    const edge = edges.find(([a, b]) => distance(nearestOn(a, b, place), near) < 1e-9);
    return { place: nearestOn(...edge, round).map(clean), on: "edge" };
  }

  nearest(places, place, within) {
    let found = null, least = within;
    for (const own of places) {
      const away = distance(own, place);
      if (away <= least) [found, least] = [own, away];
    }
    return found;
  }

  /** The place at a right angle to the axes or to the edge before. */
  square(place, from) {
    const last = from.at(-1), before = from.at(-2);
    const angles = [0, Math.PI / 2];
    if (before) {
      const own = Math.atan2(last[1] - before[1], last[0] - before[0]);
      angles.push(own, own + Math.PI / 2);
    }
    const { step } = this;
    const on = angles.map(angle => {
      const along = (place[0] - last[0]) * Math.cos(angle) + (place[1] - last[1]) * Math.sin(angle);
      const length = Math.round(along / step) * step;
      return [last[0] + length * Math.cos(angle), last[1] + length * Math.sin(angle)].map(toThousandths);
    });
    return on.reduce((best, own) => distance(own, place) < distance(best, place) ? own : best);
  }
}

/** The element that is being drawn. */
class Draft {
  constructor(drawing) {
    this.drawing = drawing;
    this.tool = "select";
    this.points = [];
    /** Where the next corner would be. */
    this.next = null;
    this.typed = document.getElementById("draw-typed");
    this.typed.addEventListener("keydown", event => this.keyTyped(event));
    this.typed.addEventListener("blur", () => this.endTyping());
    this.buildTools();
  }

  get pencil() {
    return PENCILS[this.tool];
  }

  get isBegun() {
    return this.points.length > 0;
  }

  buildTools() {
    const buttons = Object.entries(PENCILS).map(([name, { key, title }]) => {
      const kbd = element("kbd", { textContent: key.toUpperCase() });
      const made = element("button", { id: `draw-${name}`, title: PENCILS[name].hint }, `${title} `, kbd);
      made.addEventListener("click", () => this.choose(name));
      return made;
    });
    document.getElementById("draw-tools").prepend(...buttons);
  }

  /** Chooses a tool; the plan gets the focus, so that keys draw. */
  choose(name, isKept = false) {
    this.cancel();
    this.tool = name;
    for (const own of Object.keys(PENCILS)) {
      document.getElementById(`draw-${own}`).ariaPressed = String(own === name);
    }
    for (const field of document.querySelectorAll("#draw-options [data-tools]")) {
      field.hidden = field.dataset.tools !== name;
    }
    this.drawing.sheet.root.classList.toggle("draws", name !== "select");
    if (!isKept) this.drawing.sheet.root.focus({ preventScroll: true });
    this.drawing.showAll();
  }

  /** What to do, in words. */
  get hint() {
    const { form, hint } = this.pencil, count = this.points.length;
    if (!form) return this.drawing.selected ? this.drawing.selectedHint : hint;
    const free = "Alt: no snapping.";
    if (!count) return `${hint} ${free} Keys: arrows and Enter, or type a place: =3;4.`;
    const opposite = "The opposite corner: click, press Enter, or type 8x6 for 8 m × 6 m.";
    if (form === "box") return `${opposite} ${free} Escape ends.`;
    const typed = `Type 4.5 for a length, or 4.5,90 for length and angle. Shift: right angles. ${free}`;
    if (form === "line" || form === "spot") return `The other end: click or press Enter. ${typed}`;
    const enough = count >= (form === "area" ? 3 : 2);
    const close = form === "area" ? "Click the first corner, or press Enter twice, to close." : "Enter twice ends.";
    return `The next corner. ${enough ? close : ""} ${typed}`;
  }

  /** Points at the next place, as the pointer or the arrow keys do. */
  point(place, options) {
    const from = this.points, found = this.drawing.snapping.at(place, { ...options, from });
    this.next = found.place;
    this.on = found.on;
    this.drawing.sheet.show();
    this.drawing.tellPlace(this.next);
  }

  /** Places a point; whether that ends the element. */
  place(isByKey) {
    const { form } = this.pencil, last = this.points.at(-1), { next } = this;
    const isSame = last && distance(last, next) < 1e-6;
    const isClosing = this.points.length > 2 && form === "area" && distance(this.points[0], next) < 1e-6;
    if (isClosing || isSame && this.isEnough) return this.end();
    if (isSame) return false;
    if (form === "box" && last) return this.finish(rectangle(last, next));
    this.points.push(next);
    const isDone = form === "point" || form === "spot" && !isByKey || form === "line" && this.points.length === 2
      || form === "spot" && this.points.length === 2;
    if (isDone) return this.end();
    this.drawing.showAll();
    return false;
  }

  get isEnough() {
    const least = { area: 3, path: 2, spot: 1 }[this.pencil.form];
    return least !== undefined && this.points.length >= least;
  }

  /** Ends a drag that began with the first point. */
  drop() {
    const { form } = this.pencil, [first] = this.points, { next } = this;
    const isFlat = form === "box" || form === "area"
      ? [0, 1].some(axis => Math.abs(first[axis] - next[axis]) < 1e-6) : distance(first, next) < 1e-6;
    if (isFlat) return this.cancel();
    if (form === "box" || form === "area") return this.finish(rectangle(first, next));
    if (form === "point") this.points = [next];
    else this.points.push(next);
    return this.end();
  }

  end() {
    return this.finish(this.points);
  }

  /** Adds the element of the points to the drawing. */
  finish(points) {
    const { tool, drawing } = this, ordered = PENCILS[tool].form === "box" ? this.ordered(points) : points;
    this.points = [];
    drawing.add(tool, ordered.map(place => [...place]));
    return true;
  }

  /** A rectangle from its lower left corner on. */
  ordered(points) {
    return rectangle(...extent(points));
  }

  /** Forgets what was begun; whether something was. */
  cancel() {
    const wasBegun = this.isBegun;
    this.points = [];
    this.endTyping();
    this.drawing.showAll?.();
    return wasBegun;
  }

  /* Keys. */

  /** Moves the cross by steps of the grid. */
  step([dx, dy], count, options) {
    const { sheet } = this.drawing, start = this.next ?? sheet.center;
    const round = start.map(x => clean(Math.round(x / sheet.step) * sheet.step));
    this.isByKey = true;
    const moved = [round[0] + dx * count * sheet.step, round[1] + dy * count * sheet.step].map(clean);
    this.point(moved, { isFree: true, ...options });
    sheet.reveal(this.next);
  }

  enter() {
    if (!this.next || !this.isByKey && !this.isBegun) this.step([0, 0], 0);
    this.isByKey = true;
    this.place(true);
  }

  /** Opens the field for lengths and coordinates with its first character. */
  type(text) {
    const [x, y] = this.drawing.sheet.toSheet(this.next ?? this.points.at(-1) ?? this.drawing.sheet.center);
    Object.assign(this.typed, { hidden: false, value: text });
    this.typed.style.left = `${Math.min(x + 14, this.drawing.sheet.width - 130)}px`;
    this.typed.style.top = `${Math.max(y - 40, 4)}px`;
    this.typed.focus();
  }

  endTyping() {
    if (this.typed.hidden) return;
    this.typed.hidden = true;
    this.drawing.sheet.root.focus({ preventScroll: true });
  }

  keyTyped(event) {
    event.stopPropagation();
    if (event.key === "Escape") this.endTyping();
    if (event.key !== "Enter") return;
    event.preventDefault();
    const place = this.meant(this.typed.value);
    if (!place) {
      this.drawing.say("Type a length (4.5), length and angle (4.5,90), a size (8x6), or a place (3;4).");
      return;
    }
    this.endTyping();
    this.next = place.map(toThousandths);
    this.isByKey = true;
    if (this.isSized && this.points.length === 1) this.finish(rectangle(this.points[0], this.next));
    else this.place(true);
    this.drawing.sheet.reveal(this.next);
    this.drawing.tellPlace(this.next);
  }

  /** The place that is typed: a length, length and angle, a size, or coordinates. */
  meant(text) {
    const last = this.points.at(-1), { form } = this.pencil;
    const parts = text.trim().split(/\s*[,;x×]\s*|\s+/).map(Number);
    const isPair = parts.length === 2, isSize = /[x×]/.test(text);
    this.isSized = isSize && form === "area";
    if (!parts.every(Number.isFinite) || parts.length > 2 || !text.trim()) return null;
    if (!last || text.includes(";")) return isPair ? parts : null;
    const next = this.next ?? last;
    if (form === "box" || isSize) {
      if (!isPair) return null;
      const sign = axis => next[axis] < last[axis] ? -1 : 1;
      return [0, 1].map(axis => last[axis] + sign(axis) * parts[axis]);
    }
    const own = distance(last, next) > 0 ? Math.atan2(next[1] - last[1], next[0] - last[0]) : 0;
    const angle = isPair ? parts[1] * Math.PI / 180 : own;
    return [last[0] + parts[0] * Math.cos(angle), last[1] + parts[0] * Math.sin(angle)];
  }

  /* What is shown. */

  /** The marks of what is being drawn, in pixels. */
  marks(sheet) {
    const { points, next } = this, { form } = this.pencil, made = [];
    if (!form || !next) return made;
    const isBox = points.length === 1 && (form === "box" || form === "area" && this.isDragged);
    const corners = isBox ? rectangle(points[0], next) : points.length ? [...points, next] : [];
    if (corners.length) {
      const d = Sheet.path(corners.map(place => sheet.toSheet(place)), isBox);
      made.push(svg("path", { class: `draft${form === "area" || isBox ? " filled" : ""}`, d }));
      for (const [x, y] of points.map(place => sheet.toSheet(place))) {
        made.push(svg("circle", { class: "corner", cx: x, cy: y, r: 4 }));
      }
      const [x, y] = sheet.toSheet(next);
      made.push(svg("text", { class: "size", x: x + 12, y: y - 12 }, this.size));
    }
    const [x, y] = sheet.toSheet(next);
    made.push(svg("path", { class: "cross", d: `M${x - 14} ${y}h10m8 0h10M${x} ${y - 14}v10m0 8v10` }));
    if (this.on === "corner") made.push(svg("circle", { class: "snaps", cx: x, cy: y, r: 7 }));
    if (this.on === "edge") made.push(svg("path", { class: "snaps", d: `M${x} ${y - 8}l8 8l-8 8l-8 -8Z` }));
    return made;
  }

  /** The size of what is being drawn, in words. */
  get size() {
    const last = this.points.at(-1), [dx, dy] = [0, 1].map(axis => this.next[axis] - last[axis]);
    if (this.pencil.form === "box" || this.pencil.form === "area" && this.isDragged) {
      return `${shown(Math.abs(dx), 2)} m × ${shown(Math.abs(dy), 2)} m`;
    }
    return `${shown(Math.hypot(dx, dy), 2)} m, ${shown(Math.atan2(dy, dx) * 180 / Math.PI, 0)}°`;
  }
}
