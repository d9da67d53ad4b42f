/* Pointer and keys on the sheet of a drawing. */

class Hand {
  /** A pointer that moves less is a click; what is nearer to the pointer than this is under it, pixels. */
  static CLICK = 5;
  static NEAR = 8;

  constructor(drawing) {
    this.drawing = drawing;
    this.sheet = drawing.sheet;
    const { root } = this.sheet;
    this.fingers = new Map();
    root.addEventListener("pointerdown", event => this.press(event));
    root.addEventListener("pointermove", event => this.move(event));
    root.addEventListener("pointerup", event => this.lift(event, true));
    root.addEventListener("pointercancel", event => this.lift(event, false));
    root.addEventListener("dblclick", event => this.double(event));
    root.addEventListener("contextmenu", event => event.preventDefault());
    root.addEventListener("wheel", event => {
      event.preventDefault();
      const { left, top } = root.getBoundingClientRect();
      const factor = Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0015));
      this.sheet.zoomBy(factor, [event.clientX - left, event.clientY - top]);
    }, { passive: false });
    addEventListener("keydown", event => this.key(event));
  }

  snaps(event) {
    return { isFree: event.altKey, isSquare: event.shiftKey };
  }

  press(event) {
    const { drawing, sheet } = this, { draft } = drawing;
    sheet.root.setPointerCapture(event.pointerId);
    sheet.root.focus({ preventScroll: true });
    this.fingers.set(event.pointerId, [event.clientX, event.clientY]);
    this.from = [event.clientX, event.clientY];
    this.hasMoved = false;
    this.does = null;
    draft.isByKey = false;
    const place = sheet.toPlan(event);
    if (drawing.underlay.press(place)) return;
    if (event.button !== 0 || this.fingers.size > 1) this.does = "pan";
    else if (draft.pencil.form) this.beginDraft(event, place);
    else this.take(place);
  }

  /** Begins an element, or waits for the next click of one. */
  beginDraft(event, place) {
    const { draft } = this.drawing;
    draft.point(place, this.snaps(event));
    this.does = draft.isBegun ? "next" : "first";
    if (this.does === "first") this.begin = draft.next;
  }

  /** Takes what is under the pointer: a corner of the selected element, an element, or the sheet. */
  take(place) {
    const { drawing } = this, grip = this.gripAt(place);
    this.before = JSON.stringify(drawing.document);
    if (grip) {
      this.does = "grip";
      this.grip = drawing.selected.grip(grip.stroke, grip.at);
      drawing.corner = { path: pathText(grip.stroke.path), at: grip.at };
      drawing.showAll();
      return;
    }
    const found = this.shapeAt(place), wasSelected = found && found.text === drawing.selected?.text;
    drawing.corner = null;
    // A drag of the floor moves the sheet, unless the floor is selected.
    this.does = found && (wasSelected || found.kind !== "floor") ? "shape" : "pan";
    this.candidate = found;
    if (this.does !== "shape") return;
    drawing.select(found.text);
    this.start = place;
    this.places = drawing.selected.places.map(own => [...own]);
  }

  move(event) {
    const { drawing, sheet } = this, at = [event.clientX, event.clientY], last = this.fingers.get(event.pointerId);
    const place = sheet.toPlan(event);
    if (!last) {
      this.hover(event, place);
      return;
    }
    if (!this.hasMoved && distance(at, this.from) < Hand.CLICK) return;
    this.hasMoved = true;
    this.fingers.set(event.pointerId, at);
    if (this.fingers.size > 1) this.pinch(event.pointerId, last, at);
    else this.drag(event, place, last, at);
  }

  /** Moves the next point, unless the keys have moved it. */
  hover(event, place) {
    const { draft, underlay } = this.drawing;
    if (!draft.pencil.form || underlay.isMeasuring) this.drawing.tellPlace(place);
    else if (!draft.isByKey) draft.point(place, this.snaps(event));
  }

  drag(event, place, last, at) {
    const { drawing, sheet } = this, { draft, selected } = drawing;
    if (this.does === "pan") sheet.moveBy(at[0] - last[0], at[1] - last[1]);
    else if (this.does === "first") {
      if (!draft.isBegun) draft.points = [this.begin];
      draft.isDragged = true;
      draft.point(place, this.snaps(event));
    } else if (this.does === "next") draft.point(place, this.snaps(event));
    else if (this.does === "grip") {
      this.grip(drawing.snapping.at(place, { ...this.snaps(event), isSquare: false, skip: selected }).place);
      drawing.read();
      sheet.show();
    } else if (this.does === "shape") {
      this.shift(event, place);
      drawing.read();
      sheet.show();
    }
  }

  /** Moves the selected element so that its first place snaps. */
  shift(event, place) {
    const { drawing } = this, { selected } = drawing, [first] = this.places;
    if (!first) return;
    const wanted = first.map((x, axis) => x + place[axis] - this.start[axis]);
    const { place: to } = drawing.snapping.at(wanted, { ...this.snaps(event), isSquare: false, skip: selected });
    const by = to.map((x, axis) => x - first[axis]);
    if (event.shiftKey) by[Math.abs(by[0]) > Math.abs(by[1]) ? 1 : 0] = 0;
    selected.moveFrom(this.places, by);
  }

  /** Two fingers move and zoom the sheet. */
  pinch(id, last, at) {
    const { sheet } = this, [, other] = [...this.fingers].find(([own]) => own !== id);
    const { left, top } = sheet.root.getBoundingClientRect();
    const middle = [0, 1].map(axis => (at[axis] + other[axis]) / 2 - [left, top][axis]);
    sheet.zoomBy(Math.max(distance(at, other), 1) / Math.max(distance(last, other), 1), middle);
    sheet.moveBy((at[0] - last[0]) / 2, (at[1] - last[1]) / 2);
  }

  lift(event, isDone) {
    const { drawing } = this, { draft } = drawing;
    if (!this.fingers.delete(event.pointerId)) return;
    const { does, hasMoved } = this;
    this.does = null;
    if (does === "first" && hasMoved && draft.isBegun) {
      // The drag ends before the flag, on which the kind of the element depends, is forgotten.
      if (isDone) draft.drop();
      else draft.cancel();
      draft.isDragged = false;
    } else if ((does === "first" || does === "next") && isDone) draft.place(false);
    else if ((does === "grip" || does === "shape") && hasMoved) this.endDrag();
    else if (does === "pan" && !hasMoved && event.button === 0) drawing.select(this.candidate?.text ?? null);
  }

  /** Keeps a drag as one step of the history. */
  endDrag() {
    const { drawing } = this;
    if (this.before === JSON.stringify(drawing.document)) return;
    drawing.keep(this.before);
    drawing.refresh();
  }

  /** A double click ends what is drawn, or adds a corner to an edge. */
  double(event) {
    const { drawing, sheet } = this, { draft } = drawing, place = sheet.toPlan(event);
    if (draft.pencil.form || !drawing.selected) return;
    for (const { points, isClosed, grows } of drawing.selected.strokes) {
      if (!grows) continue;
      const at = points.findIndex((own, k) => {
        const next = points[k + 1] ?? (isClosed ? points[0] : null);
        return next && distance(nearestOn(own, next, place), place) * sheet.scale <= Hand.NEAR;
      });
      if (at < 0 || this.gripAt(place)) continue;
      const found = drawing.snapping.at(place, this.snaps(event)).place;
      drawing.change(() => points.splice(at + 1, 0, found));
      return;
    }
  }

  gripAt(place) {
    const { drawing, sheet } = this;
    if (!drawing.selected || !drawing.shown.includes(drawing.selected)) return null;
    for (const stroke of drawing.selected.strokes) {
      const at = stroke.points.findIndex(own => distance(own, place) * sheet.scale <= Hand.NEAR);
      if (at >= 0) return { stroke, at };
    }
    return null;
  }

  /** How far a place is from the line of a stroke, meters. */
  away({ points, isClosed }, place) {
    const next = (own, k) => points[k + 1] ?? (isClosed ? points[0] : own);
    return Math.min(...points.map((own, k) => distance(nearestOn(own, next(own, k), place), place)));
  }

  /** The element at a place: the edge of the selected one, then lines and points, then the smallest area. */
  shapeAt(place) {
    const { drawing, sheet } = this, near = Hand.NEAR / sheet.scale, found = [];
    for (const shape of drawing.shown) {
      for (const stroke of shape.strokes) {
        const { points, isClosed, radius } = stroke, away = this.away(stroke, place);
        if (shape === drawing.selected && away <= near) found.push([-1, shape]);
        else if (!isClosed && away <= Math.max(near, radius ?? 0)) found.push([away / near / 2, shape]);
        else if (isClosed && (away <= near || isInside(points, place))) found.push([1 + shape.area, shape]);
      }
    }
    const holes = shape => shape.kind === "floor" ? shape.strokes.slice(1) : [];
    const isInHole = shape => holes(shape).some(hole => isInside(hole.points, place));
    const here = found.filter(([, shape]) => !isInHole(shape)).sort(([a], [b]) => a - b);
    return here[0]?.[1] ?? null;
  }

  /* Keys. */

  key(event) {
    const { drawing } = this, { draft } = drawing;
    if (drawing.studio.mode !== "draw") return;
    const isField = ["INPUT", "SELECT", "TEXTAREA"].includes(event.target.tagName);
    const isControl = event.ctrlKey || event.metaKey;
    if (isControl && event.key === "Enter") {
      event.preventDefault();
      document.activeElement?.blur();
      drawing.play();
      return;
    }
    if (isField && event.target.id !== "draw-svg") return;
    const does = isControl ? this.commands(event) : event.altKey ? null : this.keys(event);
    if (!does) return;
    event.preventDefault();
    does();
    if (!draft.isBegun && event.key === "Escape") this.sheet.root.focus({ preventScroll: true });
  }

  commands({ key, shiftKey }) {
    const { drawing } = this;
    return {
      z: () => shiftKey ? drawing.redo() : drawing.undo(), y: () => drawing.redo(),
      c: getSelection().isCollapsed ? () => drawing.copy() : null,
      v: () => drawing.paste(), d: () => drawing.duplicate(),
      s: () => drawing.studio.attempt(() => drawing.studio.save("json")),
    }[key.toLowerCase()];
  }

  keys(event) {
    const { drawing, sheet } = this, { draft } = drawing, { key, shiftKey } = event;
    const isOnSheet = event.target === sheet.root || event.target === document.body;
    if (isOnSheet && draft.pencil.form && /^[\d.,;-]$/.test(key) && (draft.isBegun || !"-0".includes(key))) {
      return () => draft.type(key);
    }
    if (isOnSheet && draft.pencil.form && key === "=") return () => draft.type("");
    const named = Object.keys(PENCILS).find(name => PENCILS[name].key === key.toLowerCase());
    if (named) return () => draft.choose(named);
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[key];
    if (way && isOnSheet) return () => this.arrow(way, shiftKey ? 10 : 1);
    if (key === "Enter" && isOnSheet) return () => draft.pencil.form ? draft.enter() : drawing.nextCorner();
    return {
      Escape: () => this.escape(), Delete: () => drawing.remove(), Backspace: () => drawing.remove(),
      "+": () => sheet.zoomBy(1.5), "-": () => sheet.zoomBy(1 / 1.5), 0: () => sheet.fit(),
    }[key];
  }

  arrow(way, count) {
    const { drawing } = this;
    if (drawing.draft.pencil.form) drawing.draft.step(way, count);
    else drawing.nudge(way, count);
  }

  /** Ends what is begun: the element, the tool, the choice of a corner, the selection. */
  escape() {
    const { drawing } = this, { draft } = drawing;
    if (draft.cancel() || drawing.underlay.cancel()) return;
    if (draft.pencil.form) draft.choose("select");
    else if (drawing.corner) {
      drawing.corner = null;
      drawing.showAll();
    } else drawing.select(null);
  }
}
