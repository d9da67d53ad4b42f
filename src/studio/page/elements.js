/* The list of all elements, and the image beneath the drawing. */

class Elements {
  /** Longer lists of a kind are closed at first. */
  static MANY = 12;
  /** What can be added that has no place on the plan. */
  static MADE = {
    journey: document => ["journeys", {
      name: newName(document, "journey"), stages: [document.exits?.[0]?.name ?? "exit 1"],
    }],
    event: document => ["events", { at_secs: 60, close: document.exits?.[0]?.name ?? "exit 1" }],
    evacuated: () => ["measurements", { evacuated: {} }],
  };

  constructor(drawing) {
    this.drawing = drawing;
    this.root = document.getElementById("draw-elements");
    this.list = element("div", { id: "draw-list" });
    const words = { journey: "journey", event: "event", evacuated: "count of arrivals" };
    const adds = Object.entries(words).map(([name, text]) => {
      const made = element("button", { id: `draw-add-${name}`, textContent: `+ ${text}` });
      made.addEventListener("click", () => this.add(name));
      return made;
    });
    const buttons = element("p", { className: "adds" }, ...adds);
    this.root.append(element("h2", { textContent: "Elements" }), this.list, buttons);
  }

  add(name) {
    let path;
    this.drawing.change(document => {
      const [list, made] = Elements.MADE[name](document);
      document[list] = [...document[list] ?? [], made];
      path = [list, document[list].length - 1, ...list === "measurements" ? [name] : []];
    });
    this.drawing.select(pathText(path));
    this.drawing.form.focus();
  }

  /** Shows the list again, if it has changed. */
  show() {
    const { shapes, selected, wrong } = this.drawing;
    const state = JSON.stringify([shapes.map(shape => [shape.text, shape.name]), selected?.text, wrong?.text]);
    if (state === this.state) return;
    this.state = state;
    const focused = this.list.contains(document.activeElement) ? document.activeElement.dataset.path : null;
    const closed = new Map([...this.list.children].map(group => [group.dataset.heading, group.open]));
    const groups = Map.groupBy(shapes, shape => shape.heading);
    const made = [...groups].map(([heading, own]) => this.group(heading, own, closed.get(heading)));
    const none = element("p", { className: "soft", textContent: "nothing yet" });
    this.list.replaceChildren(...made.length ? made : [none]);
    if (focused) this.focus({ text: focused });
  }

  /** Puts the focus on an element of the list. */
  focus(shape) {
    if (shape) this.list.querySelector(`[data-path="${CSS.escape(shape.text)}"]`)?.focus();
  }

  group(heading, shapes, wasOpen) {
    const { selected, wrong } = this.drawing;
    const items = shapes.map(shape => {
      const made = element("button", { textContent: shape.name, ariaCurrent: String(shape === selected) });
      made.dataset.path = shape.text;
      made.classList.toggle("wrong", shape === wrong);
      made.style.borderLeftColor = shape.color;
      made.addEventListener("click", () => this.choose(shape));
      return element("li", {}, made);
    });
    const isOpen = wasOpen ?? shapes.length <= Elements.MANY;
    const hasSelected = shapes.includes(selected) || shapes.includes(wrong);
    const made = element("details", { open: isOpen || hasSelected },
      element("summary", { textContent: `${heading} (${shapes.length})` }), element("ul", {}, ...items));
    made.dataset.heading = heading;
    return made;
  }

  choose(shape) {
    const { drawing } = this;
    if (drawing.draft.pencil.form) drawing.draft.choose("select", true);
    drawing.select(shape.text);
    if (shape.strokes.length) drawing.sheet.reveal(shape.middle);
  }
}

/** An image beneath the drawing, to trace; it is not part of the scenario and is never sent. */
class Underlay {
  constructor(drawing) {
    this.drawing = drawing;
    const $ = id => document.getElementById(id);
    this.length = $("image-length");
    $("image-open").addEventListener("click", () => $("image-file").click());
    $("image-file").addEventListener("change", event => this.open(event.target.files[0]));
    $("image-measure").addEventListener("click", () => this.measure());
    $("image-remove").addEventListener("click", () => this.remove());
    $("image-opacity").addEventListener("input", event => this.image?.setAttribute("opacity", event.target.value));
    $("image-meters").addEventListener("change", event => this.setLength(Number(event.target.value)));
    $("image-meters").addEventListener("keydown", event => event.key === "Escape" && this.cancel());
    this.image = null;
    /** The two points whose distance is known, until it is. */
    this.points = null;
  }

  /** Whether the next click is a point for the scale. */
  get isMeasuring() {
    return this.points !== null && this.points.length < 2;
  }

  /** Lays an image into the middle of the sheet, half as wide as it. */
  open(file) {
    if (!file) return;
    const reader = new FileReader(), picture = new Image();
    reader.addEventListener("load", () => picture.src = reader.result);
    picture.addEventListener("load", () => {
      const { sheet } = this.drawing, width = sheet.width / sheet.scale / 2;
      this.pixel = width / picture.naturalWidth;
      this.size = [picture.naturalWidth, picture.naturalHeight];
      this.corner = [sheet.center[0] - width / 2, sheet.center[1] + this.pixel * this.size[1] / 2];
      const opacity = document.getElementById("image-opacity").value;
      this.image = svg("image", { href: reader.result, preserveAspectRatio: "none", opacity });
      sheet.image.replaceChildren(this.image);
      sheet.root.classList.add("traces");
      this.show();
      for (const id of ["image-measure", "image-remove"]) document.getElementById(id).disabled = false;
      this.measure();
    });
    picture.addEventListener("error", () => this.drawing.say(`${file.name} is no image that the browser can show.`));
    reader.readAsDataURL(file);
  }

  show() {
    const [x, y] = this.corner, [width, height] = this.size.map(size => size * this.pixel);
    // The sheet's y axis points up, that of an image down.
    const place = { width, height, transform: `translate(${x} ${y}) scale(1 -1)` };
    for (const [key, value] of Object.entries(place)) this.image.setAttribute(key, value);
  }

  /** Asks for two points and their distance. */
  measure() {
    this.points = [];
    this.length.hidden = true;
    document.getElementById("draw-image").open = true;
    this.drawing.draft.next = null;
    this.drawing.sheet.show();
    this.drawing.say("Click two points of the image whose distance you know, then type it.");
  }

  /** Takes a point for the scale; whether one was asked for. */
  press(place) {
    if (!this.isMeasuring) return false;
    this.points.push(place);
    this.drawing.sheet.show();
    if (this.points.length === 2) {
      this.length.hidden = false;
      const field = document.getElementById("image-meters");
      field.value = "";
      // The sheet takes the focus after the pointer was pressed.
      setTimeout(() => field.focus());
      this.drawing.say("Type the distance of the two points in meters, then press Enter.");
    } else this.drawing.say("Now the second point.");
    return true;
  }

  /** Sets the scale so that the two points have this distance; the first one stays where it is. */
  setLength(meters) {
    if (!(meters > 0) || this.points?.length !== 2) return;
    const [first, second] = this.points, factor = meters / distance(first, second);
    if (!Number.isFinite(factor)) return;
    this.pixel *= factor;
    this.corner = this.corner.map((x, axis) => first[axis] + factor * (x - first[axis]));
    this.show();
    this.cancel();
    this.drawing.say("The image has its scale: trace it.");
  }

  /** Forgets the points for the scale; whether there were some, or could be. */
  cancel() {
    const wasBegun = this.points !== null;
    this.points = null;
    this.length.hidden = true;
    this.drawing.showAll();
    return wasBegun;
  }

  /** The points for the scale, and the line between them, in pixels. */
  marks(sheet) {
    const points = this.points ?? [], made = points.map(place => sheet.crossAt(place, "scale"));
    const d = Sheet.path(points.map(place => sheet.toSheet(place)));
    return points.length === 2 ? [...made, svg("path", { class: "spot scale", d })] : made;
  }

  remove() {
    this.image?.remove();
    this.drawing.sheet.root.classList.remove("traces");
    this.image = null;
    this.cancel();
    for (const id of ["image-measure", "image-remove"]) document.getElementById(id).disabled = true;
  }
}
