/* The people at a time: where they are, and what is known about them. */

/** What people on a journey do, without and with a place. */
const DOINGS = [["walks", "walks to "], ["waits", "waits at "], ["stands in a queue", "stands in "],
  ["has ended its journey", "has ended its journey, "]];
/** Moves faster than this are jumps, meters per second: to the other end of a period. */
const FASTEST = 12;

class People {
  /** The people of a run; `again` is called when data that were missing have been decoded. */
  constructor(run, again) {
    this.run = run;
    this.scene = run.scene;
    this.again = again;
    this.palettes = Object.fromEntries(
      Object.entries(this.scene.colors).map(([name, bar]) => [name, { bar, pixels: pixels(bar) }]));
    this.stages = (this.scene.stages ?? []).map(pixel);
  }

  /** Goes to a time: finds its block, the frame in it, and the part of the way to the next frame. */
  goTo(time) {
    const { times, last } = this.run;
    const frame = this.run.frameAt(time);
    const part = this.run.partOf(frame);
    const block = this.run.block(0, part, this.again);
    // The next block is decoded before it is needed.
    if (block && part + 1 < this.run.starts.length) this.run.block(0, part + 1);
    // Before a gap in the recording, people stay where they are.
    const goesOn = frame < last && block && frame + 1 - this.run.starts[part] < block.frames;
    const duration = goesOn ? times[frame + 1] - times[frame] : 1;
    const way = goesOn ? (time - times[frame]) / duration : 0;
    const here = Math.abs(way - 1) < 1e-6 ? [frame + 1, 0] : [frame, Math.min(Math.max(way, 0), 1)];
    this.now = { block, part, frame: here[0], way: here[1], inside: here[0] - this.run.starts[part], duration };
    return block;
  }

  /** Calls `does` with x and y in meters, row and track of everybody who is there at the current time. */
  each(does, from = 0, to = this.now.block.ids.length) {
    const { block, inside, way, duration } = this.now;
    const { starts, firsts, counts } = block, [xs, ys] = block.columns, { position } = this.scene.units;
    const farthest = FASTEST * Math.max(duration, 0.1) / position;
    for (let k = from; k < to; k++) {
      const after = inside - firsts[k];
      if (after < 0 || after >= counts[k]) continue;
      const row = starts[k] + after;
      let x = xs[row], y = ys[row];
      if (way > 0 && after + 1 < counts[k]) {
        const dx = xs[row + 1] - x, dy = ys[row + 1] - y;
        if (Math.abs(dx) + Math.abs(dy) < farthest) {
          x += way * dx;
          y += way * dy;
        }
      }
      does(x * position, y * position, row, k);
    }
  }

  /** The value of a column in a row: a number in its unit, `null` if it is unknown. */
  value(name, row) {
    const column = this.now.block.columns[this.scene.columns.indexOf(name)];
    return column[row] === 0 ? null : (column[row] - 1) * this.scene.units[name];
  }

  /** What gives a row of the current block its color, as a function of the row. */
  coloring(color) {
    const { block } = this.now;
    if (color === "stage") {
      const trips = block.columns[this.scene.columns.indexOf("trip")];
      return row => {
        const trip = trips[row] - 1;
        return trip < 0 || trip % 4 === 3 ? Plan.GRAY : this.stages[(trip >> 2) % this.stages.length];
      };
    }
    const { bar, pixels } = this.palettes[color];
    const column = block.columns[this.scene.columns.indexOf(color)];
    const [first, last] = bar.range, most = pixels.length - 1;
    const factor = this.scene.units[color] / (last - first) * most;
    const offset = first / (last - first) * most;
    return row => column[row] === 0 ? Plan.GRAY
      : pixels[Math.min(Math.max(Math.round((column[row] - 1) * factor - offset), 0), most)];
  }

  /** A person that is present now. */
  person(id) {
    if (id === null || !this.now?.block) return null;
    const k = Run.find(this.now.block, id, this.now.inside);
    let found = null;
    if (k >= 0) this.each((x, y, row) => found = { id, k, row, place: [x, y] }, k, k + 1);
    return found;
  }

  /** The person at a place or within a distance of it, meters. */
  near([x, y], distance) {
    if (!this.now?.block) return null;
    const { block } = this.now;
    let found = null, nearest = distance;
    this.each((ox, oy, row, k) => {
      const away = Math.hypot(ox - x, oy - y) - this.radius(k);
      if (away < nearest) [nearest, found] = [away, { id: block.ids[k], k, row, place: [ox, oy] }];
    });
    return found;
  }

  /** The places of a person from a time on, as far as they are in the current block. */
  path(id, time) {
    const { block, inside, part } = this.now, first = this.run.frameAt(time) - this.run.starts[part];
    const { position } = this.scene.units, places = [];
    for (let frame = Math.max(first, 0); frame <= inside; frame++) {
      const k = Run.find(block, id, frame);
      if (k < 0) continue;
      const row = block.starts[k] + frame - block.firsts[k];
      places.push([block.columns[0][row] * position, block.columns[1][row] * position]);
    }
    return places;
  }

  /** The radius of a person, meters. */
  radius(k) {
    return this.now.block.radii[k] * this.scene.units.radius;
  }

  /** The accelerations of a person in the current frame, in m/s²: name, color, x and y; empty without any. */
  forces(id) {
    if (!this.scene.terms.length) return [];
    const block = this.run.block(1, this.now.part, this.again);
    const k = block ? Run.find(block, id, this.now.inside) : -1;
    if (k < 0) return [];
    const row = block.starts[k] + this.now.inside - block.firsts[k], unit = this.scene.units.acceleration;
    return this.scene.terms.map(([name, color], term) => {
      const [x, y] = [0, 1].map(axis => block.columns[2 * term + axis][row] * unit);
      return { name, color, x, y, size: Math.hypot(x, y) };
    });
  }

  /** The persons of the current block whose forces are recorded; at most a dozen. */
  withForces(then) {
    if (!this.scene.terms.length || !this.now) return [];
    const block = this.run.block(1, this.now.part, then);
    return block ? [...new Set(block.ids)].slice(0, 12) : [];
  }

  /** What is known about a person now: names and texts. */
  facts({ id, k, row }) {
    const { block } = this.now;
    const [density, speed] = ["density", "speed"].map(name => this.value(name, row));
    const facts = [
      ["person", String(id)],
      ["density", density === null ? "unknown" : `${density.toFixed(2)} P/m²`],
      ["speed", speed === null ? "unknown" : `${speed.toFixed(2)} m/s`],
    ];
    const [group, profile, journey] = this.scene.groups[block.groups[k]] ?? [];
    if (this.scene.columns.includes("trip")) {
      const trip = this.scene.columns.indexOf("trip");
      const [stage, ahead] = [block.columns[trip][row] - 1, block.columns[trip + 1][row] - 1];
      if (journey) facts.push(["journey", journey]);
      const does = DOINGS[stage & 3];
      const text = ahead >= 0 ? does[1] + this.scene.places[ahead] : does[0];
      if (stage >= 0) facts.push([`stage ${(stage >> 2) + 1}`, text]);
    }
    if (group) facts.push(["group", `${group}, profile ${profile}`]);
    return facts;
  }
}
