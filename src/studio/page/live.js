/* A run that goes on: its parts come from the program, and the oldest are forgotten. */

/** A run whose frames come while it is played. */
class LiveRun extends Run {
  static MOST = 48;
  /** The most bytes and frames that are kept, and the most events. */
  static MOST_BYTES = 96e6;
  static MOST_FRAMES = 20_000;
  static MOST_EVENTS = 1000;
  /** The time that the program may wait for the next frame, between two requests, and before the next attempt, ms. */
  static WAIT = 1000;
  static PAUSE = 5;
  static RETRY = 2000;
  /** Times that differ by less are the same, seconds. */
  static SAME = 1e-6;
  /** The doors of times are kept this far apart, seconds, and whenever one opens or closes. */
  static APART = 0.2;
  /** The most plans that are kept. */
  static MOST_PLANS = 32;

  /** A run of the program, by its number, with the first frames. */
  static async open(id) {
    const run = new LiveRun(await ask(`runs/${id}`));
    await run.poll(0);
    return run;
  }

  /** The names of the closed doors among some. */
  static closedOf(doors) {
    return doors.filter(door => !door.open).map(door => door.name).join("\n");
  }

  constructor(described) {
    super(described.scene);
    const { id, name, document, controls, duration_secs: duration, state } = described;
    Object.assign(this, { id, name, document, controls, duration, state });
    /** The times of states, and the doors then. */
    this.doors = [];
    /** The marks of the plan, by the doors that are closed. */
    this.plans = new Map();
    this.keepPlan(described);
    this.known = { epoch: 0, after: 0, changes: 0 };
    /** How often the state came as the answer to something else than a request for frames. */
    this.answers = 0;
    /** The bytes of all parts. */
    this.bytes = 0;
    /** The seconds of the run that an answer brings. */
    this.batch = 0;
    /** Whether the program answers, and why the run cannot go on, if it is closed. */
    this.isConnected = true;
    this.closed = null;
  }

  get newest() {
    return this.times[this.last] ?? 0;
  }

  /** The digits after the point that the times of frames need. */
  get digits() {
    const { time, frame } = this.state, step = time / frame;
    const isExact = digits => Math.abs(step * 10 ** digits - Math.round(step * 10 ** digits)) < 1e-6;
    return frame ? [2, 3, 4].find(isExact) ?? 3 : 2;
  }

  /** Asks for frames until the signal; `then` is called when there are some, or another state. */
  async listen(signal, then) {
    while (!signal.aborted && !this.closed) {
      const start = performance.now();
      let pause = document.hidden ? 1000 : LiveRun.PAUSE;
      try {
        await this.poll(LiveRun.WAIT, signal);
        this.isConnected = true;
      } catch (error) {
        if (signal.aborted) return;
        if (error instanceof Refused) this.closed = error.message;
        this.isConnected = false;
        pause = LiveRun.RETRY;
      }
      then();
      const left = pause - (performance.now() - start);
      if (left > 0) await new Promise(resolve => setTimeout(resolve, left));
    }
  }

  /** Takes the frames that are new, waiting for them up to a time in milliseconds. */
  async poll(wait, signal) {
    const query = new URLSearchParams({ ...this.known, wait }), { answers } = this;
    const answer = await answerOf(`runs/${this.id}/frames?${query}`, { signal });
    const buffer = await answer.arrayBuffer(), lengths = new DataView(buffer);
    let at = 12;
    const [series, ...blocks] = [0, 1, 2].map(k => {
      at += lengths.getUint32(4 * k, true);
      return new Uint8Array(buffer.slice(at - lengths.getUint32(4 * k, true), at));
    });
    this.take(JSON.parse(new TextDecoder().decode(series)), blocks, answers !== this.answers);
  }

  /** Takes over a state that the program answers to something else. */
  takeState(state) {
    this.answers++;
    this.state = state;
  }

  /** Adds a part with its blocks of people and forces, and takes over the state unless a later one may be known. */
  take(part, blocks, isLate) {
    if (part.times.length) {
      // What is not shown now is decoded when it is looked at.
      const isShown = bytes => bytes.length && !document.hidden;
      blocks.forEach((bytes, kind) => isShown(bytes) && this.keepDecoded(bytes, kind));
      // What happened on the way to this time is told again.
      if (part.epoch !== this.known.epoch) this.forgetFrom(part.times[0], part.events[0]?.[0]);
      if (part.joins) this.batch += 0.2 * (part.times.at(-1) - this.newest - this.batch);
      blocks.forEach((bytes, kind) => this.sources[kind].push(bytes.length ? bytes : null));
      this.bytes += this.size(this.starts.length);
      this.add(part, part.joins);
      this.events.splice(0, this.events.length - LiveRun.MOST_EVENTS);
      this.forgetOldest();
    }
    this.known = { epoch: part.epoch, after: part.last, changes: isLate ? this.known.changes : part.changes ?? 0 };
    if (!isLate) this.state = part.state;
    this.keepDoors(part.state);
  }

  /** Keeps the doors of a state, except on the way to another time. */
  keepDoors({ time, doors, seeks }) {
    const [last, known] = this.doors.at(-1) ?? [-Infinity, []];
    const isNew = LiveRun.closedOf(known) !== LiveRun.closedOf(doors) || time >= last + LiveRun.APART;
    if (isNew && !seeks) this.doors.push([time, doors]);
  }

  /** The doors at a time: as they were in the last state before it that is known, or in the first. */
  doorsAt(time) {
    const k = this.doors.findLastIndex(([own]) => own <= time + LiveRun.SAME);
    return (this.doors[Math.max(k, 0)] ?? [time, this.state.doors])[1];
  }

  /** Keeps the plan, as the program describes it with the doors of now. */
  keepPlan({ scene: { below, above }, state }) {
    this.plans.set(LiveRun.closedOf(state.doors), { below, above });
    if (this.plans.size > LiveRun.MOST_PLANS) this.plans.delete(this.plans.keys().next().value);
  }

  /** Decodes a block, which is not compressed. */
  keepDecoded(bytes, kind) {
    this.keep(bytes, decoded(bytes, this.width(kind)));
  }

  async decode(bytes, kind) {
    this.keepDecoded(bytes, kind);
  }

  /** Forgets the frames from a time on, and the events from a time on: the run was set back. */
  forgetFrom(time, told = Infinity) {
    const isBefore = own => own < time - LiveRun.SAME;
    const count = this.times.findLastIndex(isBefore) + 1;
    this.times.length = count;
    for (const values of this.series) values.length = count;
    this.doors = this.doors.filter(([own]) => isBefore(own));
    this.events = this.events.filter(([own]) => own <= time + LiveRun.SAME && own < told);
    while (this.starts.length && this.starts.at(-1) >= count) {
      this.bytes -= this.size(this.starts.length - 1);
      this.starts.pop();
      for (const sources of this.sources) this.kept.delete(sources.pop());
    }
  }

  /** The bytes of a part. */
  size(part) {
    return this.sources.reduce((sum, sources) => sum + (sources[part]?.length ?? 0), 0);
  }

  /** Forgets the oldest parts, if all take too much. */
  forgetOldest() {
    const isMuch = first => this.bytes > LiveRun.MOST_BYTES || this.last - this.starts[first] > LiveRun.MOST_FRAMES;
    let first = 0;
    while (first < this.starts.length - 1 && isMuch(first)) this.bytes -= this.size(first++);
    if (first === 0) return;
    const count = this.starts[first];
    this.times.splice(0, count);
    for (const values of this.series) values.splice(0, count);
    this.doors.splice(0, Math.max(this.doors.findLastIndex(([time]) => time <= this.times[0]), 0));
    for (const sources of this.sources) sources.splice(0, first).forEach(source => this.kept.delete(source));
    this.starts = this.starts.slice(first).map(start => start - count);
    this.events = this.events.filter(([time]) => time >= this.times[0]);
  }
}
