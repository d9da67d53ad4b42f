/* CrowdTools with which one acts on people of a run that goes on, by pointer or keyboard. */

/** A number with three digits after the point, as lengths in millimeters. */
function toThousandths(value) {
  return Math.round(value * 1000) / 1000;
}

/** What the pointer does on the plan. Places are on the plan, in meters. */
class CrowdTool {
  /** Whether the person under the pointer is shown, and whether Enter begins and Enter ends it. */
  points = false;
  hasTwoEnds = false;
  /** What to do, in words. */
  hint = "";

  constructor(tools) {
    this.tools = tools;
    this.player = tools.player;
  }

  /** The radius of the brush, meters. */
  get brush() {
    return this.tools.number("brush");
  }

  press() {}
  drag() {}
  release() {}

  /** Enter, where it is more than a click. */
  apply(place) {
    this.press(place);
    this.release(place);
  }

  /** Forgets what was begun; whether something was. */
  cancel() {
    return false;
  }

  draw() {}

  /** A place in the coordinates of the scenario. */
  inScenario(place) {
    return place.map((x, axis) => toThousandths(x + this.player.scene.origin[axis]));
  }

  /** The ids of people whose centers lie within the brush. */
  within([x, y]) {
    const { people } = this.player, ids = [];
    const { ids: all } = people.now.block;
    people.each((ox, oy, row, k) => {
      if (Math.hypot(ox - x, oy - y) <= this.brush) ids.push(all[k]);
    });
    return ids;
  }
}

/** Moves the plan; a click follows a person. */
class HandTool extends CrowdTool {
  points = true;
  hint = "Drag moves the plan; a click follows a person.";
}

/** Pushes the people in a square. */
class PushTool extends CrowdTool {
  /** Acceleration per meter dragged and the largest, m/s²; its duration, seconds. */
  static PER_METER = 5;
  static MOST = 20;
  static SECS = 0.5;

  hasTwoEnds = true;
  hint = "Drag from the people to where they are pushed.";

  press(place) {
    this.from = this.to = place;
  }

  drag(place) {
    this.to = place;
  }

  cancel() {
    const isBegun = Boolean(this.from);
    this.from = null;
    return isBegun;
  }

  /** The way of the drag, its length, and the acceleration. */
  get pull() {
    const way = [0, 1].map(axis => this.to[axis] - this.from[axis]), length = Math.hypot(...way);
    return { way, length, acceleration: Math.min(PushTool.PER_METER * length, PushTool.MOST) };
  }

  async release(place) {
    this.to = place;
    const { way, length, acceleration } = this.pull, { from } = this;
    this.from = null;
    if (length < 0.05) return;
    const half = this.tools.number("side") / 2, value = toThousandths(acceleration);
    const region = [-half, half].map(off => this.inScenario(from.map(x => x + off)));
    const push = {
      name: "push", region, for_secs: PushTool.SECS, acceleration: [[0, value], [PushTool.SECS, value]],
      direction: way.map(x => toThousandths(x / length)),
    };
    const people = this.count(from, half), those = people === 1 ? "1 person" : `${people} people`;
    const said = people ? `A push of ${shown(acceleration, 1)} m/s² for ${those}.` : "Nobody is there to be pushed.";
    if (await this.player.intervene({ push })) this.player.say(said);
  }

  /** The number of people in the square around a place. */
  count([x, y], half) {
    let count = 0;
    this.player.people.each((px, py) => count += Math.abs(px - x) <= half && Math.abs(py - y) <= half);
    return count;
  }

  draw(pen, place) {
    const { plan } = this.player, side = this.tools.number("side");
    const [x, y] = plan.toScreen(this.from ?? place), half = side * plan.scale / 2;
    pen.lineWidth = 2;
    pen.setLineDash([]);
    pen.strokeStyle = "#b3261e";
    pen.fillStyle = "rgba(179, 38, 30, 0.12)";
    pen.fillRect(x - half, y - half, 2 * half, 2 * half);
    pen.strokeRect(x - half, y - half, 2 * half, 2 * half);
    if (!this.from) return;
    const { length, acceleration } = this.pull, [tx, ty] = plan.toScreen(this.to);
    const [dx, dy] = [tx - x, ty - y].map(d => d / Math.max(Math.hypot(tx - x, ty - y), 1));
    pen.beginPath();
    pen.moveTo(x, y);
    pen.lineTo(tx, ty);
    pen.moveTo(tx - 12 * dx + 6 * dy, ty - 12 * dy - 6 * dx);
    pen.lineTo(tx, ty);
    pen.lineTo(tx - 12 * dx - 6 * dy, ty - 12 * dy + 6 * dx);
    pen.stroke();
    const text = `${shown(acceleration, 1)} m/s² for ${PushTool.SECS} s, dragged ${length.toFixed(2)} m`;
    plan.text(pen, text, tx + 10, ty - 10, "#b3261e");
  }
}

/** The tool bar, and the tool in use. */
class CrowdTools {
  /** How far an arrow key moves the target, pixels, and with Shift. */
  static STEP = 8;
  static LEAP = 48;
  /** The most places at which a single move of the pointer acts. */
  static MOST_STEPS = 32;

  constructor(player) {
    this.player = player;
    this.tools = { hand: HandTool, push: PushTool, add: AddTool, remove: RemoveTool, goal: GoalTool };
    for (const [name, kind] of Object.entries(this.tools)) {
      this.tools[name] = new kind(this);
      document.getElementById(`tool-${name}`).addEventListener("click", () => this.choose(name));
    }
    /** Where keys act, once they were used: a place on the plan. */
    this.target = null;
    const groups = player.run.controls.groups.map(name => element("option", { value: name, textContent: name }));
    document.getElementById("group").replaceChildren(...groups);
    document.getElementById("choose").addEventListener("click", () => this.tools.add.choose());
    this.choose("hand");
  }

  /** The number in a field. */
  number(id) {
    const field = document.getElementById(id);
    return Math.min(Math.max(field.valueAsNumber || Number(field.min), Number(field.min)), Number(field.max));
  }

  choose(name) {
    this.cancel();
    this.name = name;
    this.current = this.tools[name];
    for (const own of Object.keys(this.tools)) {
      document.getElementById(`tool-${own}`).ariaPressed = String(own === name);
    }
    for (const field of document.querySelectorAll("#options [data-tools]")) {
      field.hidden = !field.dataset.tools.split(" ").includes(name);
    }
    document.getElementById("hint").textContent = this.current.hint;
    document.getElementById("top").classList.toggle("aims", name !== "hand");
    this.player.isDirty = true;
  }

  /** Whether people can be acted on: the newest frame is shown. */
  get isReady() {
    const { player } = this;
    if (!player.isBack) return Boolean(player.people.now?.block);
    player.fail(new Error("You look at an earlier time: return, or go back here, before you change something."));
    return false;
  }

  press(place) {
    this.target = null;
    if (this.name === "hand" || !this.isReady) return;
    [this.isHeld, this.place] = [true, place];
    this.current.press(place);
  }

  drag(place) {
    if (!this.isHeld) return false;
    for (const on of this.way(this.place, place)) this.current.drag(on);
    this.place = place;
    return true;
  }

  /** Places on the way of a drag, no farther apart than the brush is wide, so that a fast one leaves nothing out. */
  way(from, to) {
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]);
    const steps = Math.min(Math.max(Math.ceil(length / this.number("brush")), 1), CrowdTools.MOST_STEPS);
    return Array.from({ length: steps }, (_, k) => from.map((x, axis) => x + (k + 1) / steps * (to[axis] - x)));
  }

  release(isDone) {
    if (!this.isHeld) return false;
    this.isHeld = false;
    if (isDone) this.current.release(this.place);
    else this.current.cancel();
    return true;
  }

  /** Forgets what was begun; whether something was. */
  cancel() {
    this.isHeld = this.isAimed = false;
    return this.current?.cancel() ?? false;
  }

  /** Whether a key means something here, and does it: letters choose, arrows aim, Enter acts, Escape ends. */
  key({ key, shiftKey, target: { id } }) {
    const letter = key.toLowerCase();
    const named = Object.keys(this.tools).find(name => document.getElementById(`tool-${name}`).dataset.key === letter);
    if (named) {
      this.choose(named);
      return true;
    }
    if (this.name === "hand") return false;
    if (key === "Escape") {
      if (!this.cancel()) this.choose("hand");
      this.player.isDirty = true;
      return true;
    }
    if (id !== "top") return false;
    const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[key];
    if (way) this.aim(way, shiftKey ? CrowdTools.LEAP : CrowdTools.STEP);
    else if (key === "Enter") this.enter();
    return Boolean(way) || key === "Enter";
  }

  /** Moves the target by pixels within the plan. */
  aim(way, step) {
    const { plan, scene } = this.player;
    const at = this.target ? plan.toScreen(this.target) : [plan.width / 2, plan.height / 2];
    const ends = [plan.width, plan.height];
    this.target = plan.toPlan(at.map((x, axis) => Math.min(Math.max(x + step * way[axis], 0), ends[axis])));
    if (this.isAimed) this.current.drag(this.target);
    const [x, y] = this.target.map((x, axis) => (x + scene.origin[axis]).toFixed(2));
    this.player.say(`Target (${x}, ${y}) m; Enter acts here.`);
    this.player.isDirty = true;
  }

  /** Acts at the target: at once, or between two presses of Enter. */
  enter() {
    const { plan } = this.player;
    this.target ??= plan.toPlan([plan.width / 2, plan.height / 2]);
    if (!this.isReady) return;
    if (!this.current.hasTwoEnds) this.current.apply(this.target);
    else if (this.isAimed) this.current.release(this.target);
    else this.current.press(this.target);
    this.isAimed = this.current.hasTwoEnds && !this.isAimed;
    this.player.isDirty = true;
  }

  get hasMarks() {
    return this.name !== "hand" && Boolean(this.isHeld || this.target);
  }

  /** Draws the tool at the pointer, or at the target of the keyboard. */
  draw(pen) {
    const { plan, pointer } = this.player;
    if (this.name === "hand") return;
    const place = this.isHeld ? this.place : this.target ?? (pointer && plan.toPlan(pointer));
    if (!place) return;
    if (this.target) this.cross(pen, place);
    this.current.draw(pen, place);
  }

  cross(pen, place) {
    const [x, y] = this.player.plan.toScreen(place);
    pen.beginPath();
    for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
      pen.moveTo(x + 4 * dx, y + 4 * dy);
      pen.lineTo(x + 14 * dx, y + 14 * dy);
    }
    pen.setLineDash([]);
    pen.lineWidth = 2;
    pen.strokeStyle = "#1b2430";
    pen.stroke();
  }

  /** A goal. */
  flag(pen, place) {
    const [x, y] = this.player.plan.toScreen(place);
    pen.beginPath();
    pen.moveTo(x, y);
    pen.lineTo(x, y - 20);
    pen.lineTo(x + 13, y - 15);
    pen.lineTo(x, y - 10);
    pen.setLineDash([]);
    pen.lineWidth = 2;
    pen.strokeStyle = pen.fillStyle = "#0b62a4";
    pen.stroke();
    pen.fill();
  }
}
