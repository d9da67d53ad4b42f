/* The page: controls, the person under the pointer, the person that is followed. */

/** The length of the path behind a followed person, seconds. */
const TRAIL = 5;
/** Persons within this distance of the pointer are under it, pixels. */
const NEAR = 12;
/** With more events than this, only warnings are marked at the slider. */
const MARKS = 12;
/** Texts change at most once in this time while the run plays, milliseconds. */
const TELLING = 100;
/** The scale at which a person is followed, pixels per meter. */
const CLOSE = 100;

class Page {
  constructor(run) {
    this.run = run;
    this.scene = run.scene;
    this.plan = new Plan(this.scene);
    this.people = new People(run, () => this.isDirty = true);
    this.palettes = this.people.palettes;
    this.time = run.times[0] ?? 0;
    this.playing = false;
    this.speed = 1;
    this.color = "density";
    this.followed = null;
    this.pointer = null;
    this.hovered = null;
    this.isDirty = true;
    /** Ends the page, where another one takes its place. */
    this.ending = new AbortController();
    this.setUp();
    this.plots = new Plots(run, time => this.seek(time));
    this.open();
    const tick = now => {
      if (this.ending.signal.aborted) return;
      this.tick(now);
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  /** What the address asks for, such as a time, a person, a color or a level: `#t=12.5&id=17&color=speed`. */
  open() {
    const asked = new URLSearchParams(location.hash.slice(1));
    if (asked.get("color") in this.palettes || asked.get("color") === "stage" && this.people.stages.length) {
      this.color = asked.get("color");
    }
    document.getElementById("color").value = this.color;
    this.showColors();
    this.choose(asked.get("level"));
    this.seek(Number(asked.get("t") ?? this.scene.opens_at ?? this.time));
    if (asked.has("id")) this.follow(Number(asked.get("id")));
    else this.describe();
  }

  setUp() {
    const $ = id => document.getElementById(id), on = (id, does) => $(id).addEventListener("click", does);
    const names = { density: "density", speed: "speed" };
    if (this.people.stages.length) names.stage = "stage of the journey";
    $("color").append(...Object.entries(names).map(([value, text]) => element("option", { value, textContent: text })));
    $("color").addEventListener("change", event => {
      this.color = event.target.value;
      this.showColors();
    });
    on("play", () => this.play(!this.playing));
    on("back", () => this.step(-1));
    on("forth", () => this.step(1));
    on("nearer", () => this.zoom(1.5));
    on("farther", () => this.zoom(1 / 1.5));
    on("whole", () => this.whole());
    const levels = this.scene.levels ?? [];
    $("levels").hidden = !levels.length;
    for (const [name, text] of [[null, "all levels"], ...levels.map(([name]) => [name, name])]) {
      $("levels").append(element("button", { textContent: text, onclick: () => this.choose(name) }));
    }
    $("speed").addEventListener("change", event => this.setSpeed(Number(event.target.value)));
    $("time").addEventListener("input", event => this.seek(Number(event.target.value)));
    this.showEnds();
    addEventListener("keydown", event => this.key(event), { signal: this.ending.signal });
    new ResizeObserver(() => {
      this.plan.resize();
      this.plots?.draw();
      this.isDirty = true;
    }).observe($("plan"));
    this.listen($("top"));
  }

  /** The ends of the slider, and the marks at it. */
  showEnds() {
    const [first, last] = [this.run.times[0] ?? 0, this.run.times[this.run.last] ?? 0];
    Object.assign(document.getElementById("time"), { min: first, max: Math.max(last, first + 1e-9) });
    const isFew = this.run.events.length <= MARKS, marks = [];
    for (const [time, text, isWarning] of this.run.events) {
      if (time < first || time > last || !isFew && !isWarning) continue;
      const mark = element("i", { title: text });
      mark.style.left = `${100 * (time - first) / Math.max(last - first, 1e-9)}%`;
      marks.push(mark);
    }
    document.getElementById("marks").replaceChildren(...marks);
  }

  setSpeed(speed) {
    this.speed = speed;
  }

  /** Mouse and touch on the plan: drag, wheel and two fingers move it; a click follows a person. */
  listen(top) {
    const fingers = new Map();
    let moved = 0;
    const at = event => {
      const { left, top: above } = top.getBoundingClientRect();
      return [event.clientX - left, event.clientY - above];
    };
    top.addEventListener("pointerdown", event => {
      top.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, at(event));
      moved = 0;
      this.press(at(event), fingers.size === 1 && event.button === 0);
      this.isDirty = true;
    });
    top.addEventListener("pointermove", event => {
      const to = at(event), from = fingers.get(event.pointerId);
      this.pointer = event.pointerType === "mouse" ? to : null;
      this.isDirty = true;
      if (!from) return;
      moved += Math.hypot(to[0] - from[0], to[1] - from[1]);
      fingers.set(event.pointerId, to);
      if (this.drag(to) || moved < 6) return;
      const others = [...fingers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
      if (others.length) {
        const apart = place => Math.hypot(place[0] - others[0][0], place[1] - others[0][1]);
        const middle = [0, 1].map(k => (to[k] + others[0][k]) / 2);
        this.plan.zoomBy(Math.max(apart(to), 1) / Math.max(apart(from), 1), middle);
        this.plan.moveBy((to[0] - from[0]) / 2, (to[1] - from[1]) / 2);
      } else {
        this.isHeld = true;
        this.plan.moveBy(to[0] - from[0], to[1] - from[1]);
      }
    });
    const lift = event => {
      fingers.delete(event.pointerId);
      if (this.release(event.type === "pointerup") || event.type !== "pointerup" || moved >= 6) return;
      this.click(at(event));
    };
    top.addEventListener("pointerup", lift);
    top.addEventListener("pointercancel", lift);
    top.addEventListener("pointerleave", () => {
      this.pointer = null;
      this.isDirty = true;
    });
    top.addEventListener("wheel", event => {
      event.preventDefault();
      this.plan.zoomBy(Math.exp(-event.deltaY * (event.deltaMode ? 0.05 : 0.0015)), at(event));
      this.isDirty = true;
    }, { passive: false });
  }

  /** A pointer is pressed at a place on the screen: the only one, or one of several. */
  press() {}

  /** A pointer is dragged; whether that does something else than moving the plan. */
  drag() {
    return false;
  }

  /** A pointer is lifted; whether that ended something else than moving the plan. */
  release() {
    return false;
  }

  key(event) {
    if (["SELECT", "INPUT"].includes(event.target.tagName) && event.key !== "Escape") return;
    const does = {
      " ": () => this.play(!this.playing),
      ArrowLeft: () => this.step(-1),
      ArrowRight: () => this.step(1),
      "+": () => this.zoom(1.5),
      "-": () => this.zoom(1 / 1.5),
      0: () => this.whole(),
      Escape: () => this.follow(null),
    }[event.key];
    if (!does || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    does();
  }

  /** Shows one level of a building and fades the others, or shows all. */
  choose(name) {
    const levels = this.scene.levels ?? [];
    this.plan.level = levels.find(([own]) => own === name) ?? null;
    const chosen = 1 + levels.indexOf(this.plan.level);
    [...document.getElementById("levels").children].forEach((button, k) => button.ariaPressed = String(k === chosen));
    this.whole();
  }

  zoom(factor) {
    this.plan.zoomBy(factor);
    this.isDirty = true;
  }

  whole() {
    this.isHeld = true;
    this.plan.fit();
    this.isDirty = true;
  }

  play(playing) {
    const last = this.run.times[this.run.last];
    if (playing && this.time >= last) this.time = this.run.times[0];
    this.playing = playing && this.run.last > 0;
    this.showPlaying();
  }

  showPlaying() {
    const button = document.getElementById("play");
    button.textContent = this.playing ? "❚❚" : "▶";
    button.setAttribute("aria-label", this.playing ? "stop" : "play");
    this.isDirty = true;
  }

  seek(time) {
    const { times, last } = this.run;
    this.time = Math.min(Math.max(Number.isFinite(time) ? time : 0, times[0] ?? 0), times[last] ?? 0);
    this.isDirty = true;
  }

  step(frames) {
    this.play(false);
    const frame = this.run.frameAt(this.time) + frames;
    this.seek(this.run.times[Math.min(Math.max(frame, 0), this.run.last)]);
  }

  /** Follows a person, or nobody. */
  follow(id) {
    this.followed = id;
    this.isHeld = false;
    if (id !== null && this.plan.scale < CLOSE) this.plan.zoom = CLOSE;
    if (id === null) this.plan.fit();
    this.isDirty = true;
    this.describe();
  }

  /** The person at a place on the screen. */
  under(place) {
    return this.people.near(this.plan.toPlan(place), NEAR / this.plan.scale);
  }

  click(place) {
    const found = this.under(place);
    if (found) this.follow(found.id);
    else if (this.followed !== null) this.follow(null);
  }

  tick(now) {
    const passed = (now - (this.before ?? now)) / 1000;
    this.before = now;
    this.advance(passed);
    if (this.isDirty) this.draw();
  }

  /** Moves on by seconds of the clock on the wall. */
  advance(passed) {
    if (!this.playing || !this.isShown) return;
    this.time += this.speed * Math.min(passed, 0.25);
    if (this.time >= this.run.times[this.run.last]) {
      this.time = this.run.times[this.run.last];
      this.play(false);
    }
    this.isDirty = true;
  }

  draw() {
    const block = this.people.goTo(this.time);
    document.getElementById("state").textContent = block ? "" : this.run.starts.length ? "reading …" : "no frames";
    const isFirst = block && !this.isShown;
    this.isDirty = false;
    this.isShown = Boolean(block);
    if (!block) return;
    if (isFirst) this.describe();
    this.chase();
    const coloring = this.people.coloring(this.color), radius = this.scene.units.radius;
    const isCovered = this.plan.isStale || this.hovered || this.hasMarks || this.hadMarks;
    this.plan.paint(disc => {
      this.people.each((x, y, row, k) => disc(x, y, block.radii[k] * radius, coloring(row)));
    });
    this.hovered = this.pointed;
    if (isCovered) this.plan.cover(pen => this.overlay(pen));
    this.hadMarks = this.hasMarks;
    document.getElementById("clock").textContent = this.clock;
    // Texts that change in every frame cannot be read, and take longer than the people.
    const at = performance.now();
    if (this.playing && at - (this.told ?? 0) < TELLING) return;
    this.told = at;
    this.tell();
  }

  /** Whether something is marked above the people. */
  get hasMarks() {
    return this.pointer || this.followed !== null;
  }

  /** The person under the pointer. */
  get pointed() {
    return this.pointer && this.under(this.pointer);
  }

  get clock() {
    return `${this.time.toFixed(2)} / ${(this.run.times[this.run.last] ?? 0).toFixed(1)} s`;
  }

  /** Keeps the followed person in the middle until the plan is moved by hand. */
  chase() {
    const own = this.people.person(this.followed);
    if (!own || this.isHeld) return;
    this.plan.center = own.place;
    this.plan.isStale = true;
  }

  /** Marks the person under the pointer, and the followed one with its path and forces. */
  overlay(pen) {
    const ring = ({ k, place }, color, width) => {
      const radius = this.people.radius(k) * this.plan.scale;
      pen.beginPath();
      pen.arc(...this.plan.toScreen(place), Math.max(radius, 3) + width, 0, 7);
      pen.setLineDash([]);
      pen.lineWidth = width;
      pen.strokeStyle = color;
      pen.stroke();
    };
    const own = this.people.person(this.followed);
    if (own) {
      this.trail(pen, own.id);
      ring(own, "#d55e00", 2.5);
      this.arrows(pen, own);
    }
    if (this.hovered) ring(this.hovered, "#1b2430", 1.5);
  }

  /** The path of the last seconds. */
  trail(pen, id) {
    pen.beginPath();
    for (const place of this.people.path(id, this.time - TRAIL)) pen.lineTo(...this.plan.toScreen(place));
    pen.setLineDash([]);
    pen.lineWidth = 2;
    pen.strokeStyle = "rgba(213, 94, 0, 0.55)";
    pen.stroke();
  }

  /** Arrows of accelerations, as long as in recordings: 0.6 m × log₁₀(1 + a / 0.1 m/s²). */
  arrows(pen, { id, place }) {
    const [x, y] = this.plan.toScreen(place);
    this.people.forces(id).forEach((force, k) => {
      const length = 0.6 * Math.log10(1 + force.size / 0.1) * this.plan.scale;
      if (length < 3) return;
      const [dx, dy] = [force.x / force.size, -force.y / force.size], head = Math.min(9, length / 2);
      const tip = [x + dx * length, y + dy * length], wide = k === 0 ? 4.5 : 2.5;
      for (const [color, width] of [["#2a2f38", wide + 1.6], [force.color, wide]]) {
        pen.strokeStyle = pen.fillStyle = color;
        pen.lineWidth = width;
        pen.beginPath();
        pen.moveTo(x, y);
        pen.lineTo(tip[0] - dx * head / 2, tip[1] - dy * head / 2);
        pen.stroke();
        const grown = head + (width - wide);
        pen.beginPath();
        pen.moveTo(tip[0] + dx * (width - wide), tip[1] + dy * (width - wide));
        pen.lineTo(tip[0] - dx * grown + dy * grown / 2, tip[1] - dy * grown - dx * grown / 2);
        pen.lineTo(tip[0] - dx * grown - dy * grown / 2, tip[1] - dy * grown + dx * grown / 2);
        pen.fill();
      }
    });
  }

  /** The numbers of the current time. */
  tell() {
    const $ = id => document.getElementById(id);
    $("time").value = this.time;
    this.plots?.show(this.people.now.frame, this.time);
    const [time, text] = this.run.events.findLast(([time]) => time <= this.time + 1e-9) ?? [];
    $("event").textContent = text ? `${shown(time, 2)} s: ${text}` : "";
    const tip = $("tip");
    tip.hidden = !this.hovered;
    $("top").classList.toggle("points", Boolean(this.hovered));
    if (this.hovered) {
      const lines = this.people.facts(this.hovered).map(([name, value]) => element("div", {}, `${name} ${value}`));
      tip.replaceChildren(...lines);
      const [x, y] = this.plan.toScreen(this.hovered.place);
      tip.style.left = `${Math.max(4, Math.min(x + 16, this.plan.width - tip.offsetWidth - 4))}px`;
      tip.style.top = `${Math.max(4, Math.min(y + 14, this.plan.height - tip.offsetHeight - 4))}px`;
    }
    this.tellScale();
    if (this.followed !== null) this.describe();
  }

  tellScale() {
    const bar = document.getElementById("scale"), most = 0.2 * this.plan.width / this.plan.scale;
    const decade = 10 ** Math.floor(Math.log10(most));
    const length = [5, 2, 1].map(factor => factor * decade).find(length => length <= most);
    bar.style.width = `${length * this.plan.scale}px`;
    bar.firstElementChild.textContent = `${shown(length)} m`;
  }

  /** The card of the followed person. */
  describe() {
    const card = document.getElementById("person");
    if (this.followed === null) {
      const hint = "Point at a person for the numbers. Click or tap to follow.";
      card.replaceChildren(element("h2", { textContent: "People" }), element("p", { textContent: hint }),
        ...this.offered());
      return;
    }
    const leave = { textContent: "×", title: "follow nobody (Esc)", onclick: () => this.follow(null) };
    const close = element("button", leave);
    const head = element("h2", {}, `Person ${this.followed}`, close);
    const own = this.people.person(this.followed);
    if (!own) {
      card.replaceChildren(head, element("p", { textContent: "is not here at this time." }));
      return;
    }
    const [ox, oy] = this.scene.origin, [x, y] = own.place;
    const facts = [...this.people.facts(own).slice(1), ["at", `(${(x + ox).toFixed(2)}, ${(y + oy).toFixed(2)}) m`]];
    const row = (...cells) => element("tr", {}, ...cells.map(cell => element("td", {}, cell)));
    const forces = this.people.forces(own.id).map(force => {
      const bar = element("span", { className: "force" });
      const width = 25 * Math.log10(1 + force.size / 0.1);
      if (width >= 1) bar.style.cssText = `background:${force.color};outline:1px solid #2a2f38;width:${width}px`;
      return row(force.name, `${force.size.toFixed(2)} m/s²`, bar);
    });
    card.replaceChildren(head, element("table", {}, ...facts.map(fact => row(...fact))));
    if (!forces.length) return;
    const scale = "Bars and arrows grow with the logarithm of the value.";
    card.append(element("p", { textContent: "Accelerations" }), element("table", {}, ...forces),
      element("p", { className: "soft", textContent: scale }));
  }

  /** The persons whose forces are recorded, to be followed. */
  offered() {
    const ids = this.people.withForces(() => this.describe());
    if (!ids.length) return [];
    const chips = ids.map(id => element("button", { textContent: id, onclick: () => this.follow(id) }));
    return [element("p", { textContent: "Forces are recorded for these:" }),
      element("div", { className: "ids" }, ...chips)];
  }

  showColors() {
    const $ = id => document.getElementById(id), palette = this.palettes[this.color];
    $("colors").hidden = !palette;
    $("stages").hidden = Boolean(palette);
    this.isDirty = true;
    if (!palette) {
      const stage = (color, k) => {
        const mark = element("i");
        mark.style.cssText = `display:inline-block;width:11px;height:11px;border-radius:6px;background:${color}`;
        return element("span", {}, mark, ` stage ${k + 1}`);
      };
      $("stages").replaceChildren(...this.scene.stages.map(stage));
      return;
    }
    const { bar, pixels } = palette, canvas = $("colors").firstElementChild, pen = canvas.getContext("2d");
    const image = pen.createImageData(pixels.length, 1);
    new Uint32Array(image.data.buffer).set(pixels);
    pen.putImageData(image, 0, 0);
    const [first, last] = bar.range;
    const numbers = bar.ticks.map(([value, text], k) => {
      const isLast = k === bar.ticks.length - 1;
      const number = element("span", { textContent: isLast ? `${text} ${bar.text.match(/\[(.*)\]/)[1]}` : text });
      number.style.left = `${100 * (value - first) / (last - first)}%`;
      return number;
    });
    $("colors").lastElementChild.replaceChildren(...numbers);
  }
}

addEventListener("DOMContentLoaded", async () => {
  if (!document.getElementById("scene")) return; // another script uses what is above
  try {
    const page = new Page(await Run.read());
    globalThis.sandboxPage = page;
    document.body.dataset.state = "ready";
  } catch (error) {
    document.getElementById("state").textContent = `This browser cannot play the page: ${error}`;
    throw error;
  }
});
