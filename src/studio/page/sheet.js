/* The sheet: the plan of a drawing as SVG, with its grid, and the places of the pointer on it. */

/** An element of SVG. */
function svg(name, attributes = {}, ...children) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

class Sheet {
  /** The least distance of the lines of the grid, pixels; what is shown of an empty drawing, meters. */
  static LINES = 12;
  static EMPTY = [[-2, -2], [22, 13]];
  /** The largest scale, pixels per meter. */
  static MOST = 4000;
  /** The kinds that are named on the sheet, the most important first; the width of a letter, pixels. */
  static NAMED = [
    "exit", "door", "entrance", "crowd", "waiting", "queue", "waypoint", "zone", "grid", "source", "lift", "label",
    "measurement", "event", "join",
  ];
  static LETTER = 6.6;
  /** The radius of people who have none of their own, meters. */
  static BODY = 0.24;
  /** The space for tools around a drawing that is shown whole. */
  static MARGIN = 0.84;

  constructor(drawing) {
    this.drawing = drawing;
    this.root = document.getElementById("draw-svg");
    this.image = svg("g");
    this.grid = svg("g", { class: "grid" });
    this.world = svg("g", { class: "world" });
    this.above = svg("g", { class: "above" });
    this.root.append(this.image, this.grid, this.world, this.above);
    this.center = [10, 5.5];
    this.scale = 40;
    new ResizeObserver(() => this.resize()).observe(this.root.parentElement);
    const on = (id, does) => document.getElementById(id).addEventListener("click", does);
    on("draw-nearer", () => this.zoomBy(1.5));
    on("draw-farther", () => this.zoomBy(1 / 1.5));
    on("draw-whole", () => this.fit());
  }

  /** Adapts to the size of the window; what was shown whole, and has not changed since, stays so. */
  resize() {
    const { clientWidth, clientHeight } = this.root.parentElement;
    if (!clientWidth || clientWidth === this.width && clientHeight === this.height) return;
    [this.width, this.height] = [clientWidth, clientHeight];
    if (this.isWhole) this.fit();
    else this.show();
  }

  /** Shows the whole drawing. */
  fit() {
    const { shapes, level } = this.drawing;
    const here = shapes.filter(shape => shape.isOn(level));
    const [low, high] = extent(here.flatMap(shape => shape.places)) ?? Sheet.EMPTY;
    this.center = [0, 1].map(axis => (low[axis] + high[axis]) / 2);
    const sides = [0, 1].map(axis => Math.max(high[axis] - low[axis], 2));
    this.isWhole = true;
    if (!this.width) return;
    this.scale = Math.min(Sheet.MARGIN * Math.min(this.width / sides[0], this.height / sides[1]), Sheet.MOST);
    this.show();
  }

  /** The distance of the lines of the grid, meters: 1, 2 or 5 times a power of ten. */
  get step() {
    const least = Sheet.LINES / this.scale, decade = 10 ** Math.floor(Math.log10(least));
    return clean([1, 2, 5, 10].map(factor => factor * decade).find(step => step >= least * 0.999));
  }

  /** A place in pixels of the sheet. */
  toSheet([x, y]) {
    return [(x - this.center[0]) * this.scale + this.width / 2, this.height / 2 - (y - this.center[1]) * this.scale];
  }

  /** A place in pixels of the window. */
  toScreen(place) {
    const { left, top } = this.root.getBoundingClientRect(), [x, y] = this.toSheet(place);
    return [x + left, y + top];
  }

  /** The place of an event of the pointer, meters. */
  toPlan({ clientX, clientY }) {
    const { left, top } = this.root.getBoundingClientRect();
    return this.atSheet([clientX - left, clientY - top]);
  }

  /** The place at pixels of the sheet. */
  atSheet([x, y]) {
    return [(x - this.width / 2) / this.scale + this.center[0], (this.height / 2 - y) / this.scale + this.center[1]];
  }

  zoomBy(factor, at = [this.width / 2, this.height / 2]) {
    const before = this.atSheet(at);
    this.isWhole = false;
    this.scale = Math.min(Math.max(this.scale * factor, 0.02), Sheet.MOST);
    const after = this.atSheet(at);
    this.center = [0, 1].map(axis => this.center[axis] + before[axis] - after[axis]);
    this.show();
  }

  /** Moves the sheet by pixels. */
  moveBy(dx, dy) {
    if (!dx && !dy) return;
    this.isWhole = false;
    this.center = [this.center[0] - dx / this.scale, this.center[1] + dy / this.scale];
    this.show();
  }

  /** Moves the sheet so far that a place is in it. */
  reveal(place) {
    const [x, y] = this.toSheet(place), margin = 40;
    const over = (at, size) => at < margin ? margin - at : at > size - margin ? size - margin - at : 0;
    this.moveBy(over(x, this.width), over(y, this.height));
  }

  /** Shows all in the next frame of the browser. */
  show() {
    this.isWaiting ??= requestAnimationFrame(() => {
      this.isWaiting = null;
      if (this.width) this.draw();
    });
  }

  draw() {
    const { scale, center: [x, y], width, height } = this;
    const matrix = `matrix(${scale} 0 0 ${-scale} ${width / 2 - x * scale} ${height / 2 + y * scale})`;
    this.world.setAttribute("transform", matrix);
    this.image.setAttribute("transform", matrix);
    this.drawGrid();
    if (this.drawn !== this.drawing.version) this.drawShapes();
    this.drawAbove();
    this.drawScale();
  }

  drawGrid() {
    const lines = step => {
      const [left, top] = this.atSheet([0, 0]), [right, bottom] = this.atSheet([this.width, this.height]);
      let path = "";
      for (let k = Math.ceil(left / step); k * step <= right; k++) {
        path += `M${this.toSheet([k * step, 0])[0].toFixed(1)} 0V${this.height}`;
      }
      for (let k = Math.ceil(bottom / step); k * step <= top; k++) {
        path += `M0 ${this.toSheet([0, k * step])[1].toFixed(1)}H${this.width}`;
      }
      return svg("path", { d: path });
    };
    const fine = lines(this.step), coarse = lines(10 ** Math.ceil(Math.log10(this.step) + 1e-6));
    coarse.setAttribute("class", "coarse");
    this.grid.replaceChildren(fine, coarse);
  }

  drawScale() {
    const bar = document.getElementById("draw-scale"), most = 0.2 * this.width / this.scale;
    const decade = 10 ** Math.floor(Math.log10(most));
    const length = [5, 2, 1].map(factor => factor * decade).find(length => length <= most);
    bar.style.width = `${length * this.scale}px`;
    bar.firstElementChild.textContent = `${Number(length.toPrecision(1))} m`;
  }

  /** A line through points as SVG writes it. */
  static path(points, isClosed) {
    return `M${points.map(place => place.join(" ")).join("L")}${isClosed ? "Z" : ""}`;
  }

  /** The elements, in meters. */
  drawShapes() {
    const { drawing } = this;
    this.drawn = drawing.version;
    this.world.replaceChildren(...drawing.shown.flatMap(shape => this.marksOf(shape)));
  }

  marksOf(shape) {
    const main = shape.strokes.filter(stroke => stroke.path.at(-1) !== "goal" || shape.kind === "goal");
    const outlines = main.filter(stroke => stroke.least > 1), spots = main.filter(stroke => stroke.least === 1);
    const look = { class: `shape ${shape.kind}`, "data-path": shape.text };
    const marks = [];
    if (outlines.length) {
      const d = outlines.map(({ points, isClosed }) => Sheet.path(points, isClosed)).join("");
      if (outlines.every(stroke => !stroke.isClosed)) look.class += " open";
      marks.push(svg("path", { ...look, d, "fill-rule": "evenodd" }));
    }
    for (const { points: [[x, y]], radius, path } of spots) {
      const r = radius ?? (path.at(-1) === "position" ? shape.element.radius ?? Sheet.BODY : null);
      if (r !== null) marks.push(svg("circle", { ...look, cx: x, cy: y, r }));
    }
    return marks;
  }

  /** What is drawn in pixels: names, marks, the selection and what is being drawn. */
  drawAbove() {
    const { drawing } = this, { selected, draft, corner } = drawing, made = [];
    for (const shape of drawing.shown) made.push(...this.flagsOf(shape));
    made.push(...this.names());
    if (selected) made.push(...this.gripsOf(selected, corner));
    made.push(...drawing.underlay.marks(this), ...draft.marks(this));
    if (drawing.wrongPlace) made.push(this.crossAt(drawing.wrongPlace, "wrong"));
    this.above.replaceChildren(...made);
    drawing.showMark();
    drawing.showEmpty();
  }

  /** A small cross at a place. */
  crossAt(place, kind) {
    const [x, y] = this.toSheet(place);
    return svg("path", { class: `spot ${kind}`, d: `M${x - 6} ${y - 6}l12 12m0 -12l-12 12` });
  }

  /** The goals of the selected element, and the goal of all. */
  flagsOf(shape) {
    const made = [];
    const isFlag = stroke => stroke.least === 1 && ["goal", "facing"].includes(stroke.path.at(-1));
    for (const stroke of shape.strokes.filter(isFlag)) {
      if (shape.kind !== "goal" && shape !== this.drawing.selected) continue;
      const [x, y] = this.toSheet(stroke.points[0]), [fx, fy] = this.toSheet(shape.middle);
      made.push(svg("path", { class: "leads", d: `M${fx} ${fy}L${x} ${y}` }));
      made.push(svg("path", { class: "flag", d: `M${x} ${y}v-20l13 5l-13 5` }));
    }
    return made;
  }

  /** Names that fit, the more important ones first: none over another one. */
  names() {
    const rank = ({ kind }) => Sheet.NAMED.indexOf(kind), taken = [];
    const named = this.drawing.shown.filter(shape => shape.strokes.length && rank(shape) >= 0);
    const names = named.sort((a, b) => rank(a) - rank(b)).map(shape => this.nameOf(shape));
    return names.filter(name => {
      if (!name) return false;
      const width = Sheet.LETTER * name.text.length, left = name.isMiddle ? name.x - width / 2 : name.x;
      const box = [left, name.y - 12, left + width, name.y + 3];
      const isFree = taken.every(own => box[0] > own[2] || own[0] > box[2] || box[1] > own[3] || own[1] > box[3]);
      if (isFree) taken.push(box);
      return isFree;
    }).map(({ text, x, y, isMiddle }) =>
      svg("text", { class: "name", x, y, "text-anchor": isMiddle ? "middle" : "start" }, text));
  }

  /** The name of an element and its place in pixels, unless it is wider than the element. */
  nameOf(shape) {
    const { kind, strokes: [first] } = shape, [x, y] = this.toSheet(shape.middle);
    const [low, high] = extent(first.points).map(place => this.toSheet(place));
    const number = shape.element.number ?? (kind === "grid" ? shape.element.columns * shape.element.rows : null);
    const text = String(number ? `${shape.name}: ${number}` : shape.name);
    const room = first.isClosed ? high[0] - low[0] + 30 : (shape.element.width ?? Infinity) * this.scale;
    if (Sheet.LETTER * text.length > room) return null;
    if (first.isClosed || kind === "label") return { text, x, y: y + 4, isMiddle: true };
    const isUpright = Math.abs(high[0] - low[0]) < Math.abs(high[1] - low[1]);
    return isUpright ? { text, x: x + 8, y: y + 4 } : { text, x, y: y - 8, isMiddle: true };
  }

  /** The outline and the corners of the selected element. */
  gripsOf(shape, corner) {
    const made = [];
    for (const stroke of shape.strokes) {
      const points = stroke.points.map(place => this.toSheet(place));
      made.push(svg("path", { class: "chosen", d: Sheet.path(points, stroke.isClosed) }));
      points.forEach(([x, y], k) => {
        const isActive = corner && corner.path === pathText(stroke.path) && corner.at === k;
        const look = { class: isActive ? "grip active" : "grip", x: x - 5, y: y - 5, width: 10, height: 10 };
        made.push(svg("rect", look));
      });
    }
    return made;
  }
}
