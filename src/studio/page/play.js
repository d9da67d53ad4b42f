/* The player: the viewer of pages for a run that goes on, with controls for it. */

/** A run that goes on: the page follows its newest frame, or looks back. */
class Player extends Page {
  /** How far the page may stay behind the newest frame, so that people move evenly, seconds of real time. */
  static LATE = 0.06;
  /** For so long after something was done, the newest frame is shown at once, milliseconds. */
  static HURRY = 200;
  /** Plots and doors change at most once in this time, milliseconds. */
  static PLOTTING = 500;
  static LISTING = 200;
  /** The most events in the list. */
  static MOST_EVENTS = 60;
  /** How far `B` goes back, seconds. */
  static BACK = 5;
  /** How long the browser may take to write a saved file, milliseconds. */
  static KEPT = 60_000;
  /** Lines that end where their room ends; the whole text is in the title. */
  static LINES = ["message", "hint", "said", "event", "going", "digest"];
  /** The player in the page, and the elements for the next one. */
  static current = null;
  static empty = null;

  /** Plays a run of the program, by its number, in place of the one that was played before. */
  static async open(id) {
    const run = await LiveRun.open(id);
    Player.current?.close();
    const section = document.getElementById("playing");
    Player.empty ??= section.cloneNode(true);
    section.replaceChildren(...Player.empty.cloneNode(true).childNodes);
    return Player.current = new Player(run);
  }

  /** Stops asking for frames. The run itself stays with the program, and waits. */
  close() {
    this.ending.abort();
    if (this.run.state.playing) ask(`runs/${this.run.id}/control`, { play: false }).catch(() => {});
  }

  setUp() {
    const $ = id => document.getElementById(id), on = (id, does) => $(id).addEventListener("click", does);
    $("plan").before($("tools"));
    $("plan").append($("problem"));
    $("person").after($("own"), $("doors"), $("parameters"), $("happened"));
    $("moment").prepend($("event"));
    $("stage").append($("moment"), $("acts"));
    $("speed").append(element("option", { value: "Infinity", textContent: "as fast as possible" }));
    super.setUp();
    /** The number of drawn pictures. */
    this.pictures = 0;
    this.isBack = false;
    this.hurries = 0;
    /** Where the followed person was: times and places. */
    this.steps = [];
    this.plotted = this.listed = 0;
    this.tools = new CrowdTools(this);
    this.doors = new Doors(this);
    on("goback", () => this.goBack(this.time));
    on("return", () => this.return());
    on("dismiss", () => this.fail(null));
    on("back5", () => this.goBack(this.time - Player.BACK));
    on("fork", () => this.fork());
    on("edit", () => studio.edit(this.run.document));
    on("check", () => this.check());
    on("all", () => this.tellAll());
    $("pace").addEventListener("input", event => $("paced").textContent = `${event.target.value} m/s`);
    $("pace").addEventListener("change", event => this.setPace(Number(event.target.value)));
    const { signal } = this.ending;
    for (const line of Player.LINES) {
      $(line).addEventListener("pointerenter", ({ target }) => target.title = target.textContent, { signal });
    }
    document.addEventListener("click", event => this.giveBack(event), { signal });
    this.run.listen(signal, () => this.update());
  }

  open() {
    super.open();
    this.return();
    this.update();
  }

  /* What the program is asked for. */

  /** Does something that the program may refuse, and shows why; its result, or nothing. */
  async attempt(does) {
    try {
      const result = await does();
      this.fail(null);
      return result;
    } catch (error) {
      this.fail(error);
      return null;
    }
  }

  /** Shows why something did not work, near the plan, or nothing. */
  fail(error) {
    document.getElementById("problem").hidden = !error;
    document.getElementById("reason").textContent = error ? Player.words(error) : "";
  }

  /** An error as a sentence, without the key of the request. */
  static words(error) {
    if (error instanceof TypeError) return `The program does not answer: ${error.message}`;
    const reason = (error.reason ?? error.message).replace(/^(speed|follow|to|step|play): /, "");
    return `${reason[0].toUpperCase()}${reason.slice(1)}${/[.!?]$/.test(reason) ? "" : "."}`;
  }

  /** Says what was done. */
  say(text) {
    document.getElementById("said").textContent = text;
  }

  async control(asked) {
    const answer = await this.attempt(() => ask(`runs/${this.run.id}/control`, asked));
    if (!answer) return;
    this.run.takeState(answer.state);
    this.update();
  }

  /** Changes the run, as an element of `interventions` does; what became of people who were to be added. */
  async intervene(action) {
    if (this.refusesBack()) return null;
    const done = await this.attempt(() => ask(`runs/${this.run.id}/intervene`, action));
    this.hurries = performance.now() + Player.HURRY;
    return done;
  }

  /** Plays or stops; who looks back returns, and the run plays. */
  play(playing) {
    const wasBack = this.isBack;
    this.return();
    this.control({ play: playing || wasBack });
  }

  setSpeed(speed) {
    this.control({ speed: Number.isFinite(speed) ? speed : null });
  }

  /** Sets the run back to a time; it goes on from there if it plays. */
  goBack(time) {
    const { playing } = this.run.state;
    this.return();
    return this.control({ to: Math.max(time, 0), ...(playing ? { play: true } : {}) });
  }

  /** Whether one looks back, where nothing can be done; says so. */
  refusesBack() {
    if (!this.isBack) return false;
    this.fail(new Error(`You look at ${this.clock}. Press “Go back here” or “Return” first.`));
    return true;
  }

  async fork() {
    if (this.refusesBack()) return;
    const forked = await this.attempt(() => ask(`runs/${this.run.id}/fork`, {}));
    if (forked && !open(`${location.pathname}#run=${forked.run}`, "_blank")) {
      this.say(`The browser opened no tab for the fork: it is run ${forked.run} on the start page.`);
    }
  }

  async check() {
    if (this.refusesBack()) return;
    const line = document.getElementById("digest");
    line.textContent = "";
    const found = await this.attempt(() => ask(`runs/${this.run.id}/digest`));
    if (!found) return;
    line.textContent = `state_sha256 ${found.state_sha256} in frame ${found.frame}, ${shown(found.time)} s`;
  }

  /** Saves what was played: its scenario, or a page, a recording, a report or a picture of it. */
  async save(kind) {
    this.say(`The program makes the file (${kind}) …`);
    const file = await this.attempt(async () => {
      const answer = await answerOf(`runs/${this.run.id}/saved?as=${kind}`);
      const [, name] = /filename="([^"]+)"/.exec(answer.headers.get("Content-Disposition")) ?? [null, `run.${kind}`];
      return { name, content: await answer.blob() };
    });
    this.say("");
    if (!file) return;
    this.say(kind === "json" ? await this.savedWords(file) : `${file.name} is saved.`);
    const address = URL.createObjectURL(file.content);
    element("a", { href: address, download: file.name }).click();
    setTimeout(() => URL.revokeObjectURL(address), Player.KEPT);
  }

  /** What a saved scenario has, in words. */
  async savedWords({ name, content }) {
    const { duration_secs: end } = JSON.parse(await content.text());
    const isShown = Math.abs(end - this.time) < LiveRun.SAME;
    const result = isShown ? "now, so a run of it gives the state shown" : "so a run of it gives the state then";
    return `${name} is saved: it ends at ${shown(end)} s, ${result}.`;
  }

  /* Time. */

  /** Looks at the frame nearest to a time. */
  seek(time) {
    super.seek(time);
    const { times } = this.run, frame = this.run.frameAt(this.time);
    const isNearer = times[frame + 1] - this.time < this.time - times[frame];
    this.time = times[isNearer ? frame + 1 : frame] ?? 0;
    this.isBack = this.time < this.run.newest - LiveRun.SAME;
    if (this.isBack && this.run.state.playing) {
      // The run waits for those who look back.
      this.run.state = { ...this.run.state, playing: false };
      this.control({ play: false });
    }
    this.showTime();
  }

  /** Looks at the newest frame again. */
  return() {
    this.isBack = false;
    this.time = this.run.newest;
    this.isDirty = true;
    this.showTime();
  }

  /** Looks one frame back or on; at the end of what is kept, the run computes one more. */
  step(frames) {
    if (frames > 0 && !this.isBack) {
      this.control({ step: 1 });
      return;
    }
    const frame = this.run.frameAt(this.time) + frames;
    this.seek(this.run.times[Math.min(Math.max(frame, 0), this.run.last)]);
  }

  tick(now) {
    if (document.body.dataset.mode === "play") super.tick(now);
  }

  advance(passed) {
    const { newest, times, state } = this.run;
    const before = this.time;
    if (this.isBack) this.time = Math.max(before, times[0]);
    else if (!state.playing || state.seeks || performance.now() < this.hurries) this.time = newest;
    else this.time = this.following(passed, state.behind || state.speed === null ? state.rate : state.speed);
    if (this.time !== before) this.isDirty = true;
  }

  /** The time to show: it runs at the speed of the run, a little behind the newest frame, which it never waits for. */
  following(passed, speed) {
    const { newest, times, last, batch } = this.run;
    const pace = speed ?? batch / Player.LATE, frame = newest - (times[last - 1] ?? newest);
    const most = Math.max(Player.LATE * pace, frame), late = newest - this.time;
    const wanted = Math.min(Math.max(1.2 * batch, frame), most);
    const faster = Math.min(Math.max(1 + (late - wanted) / Math.max(most, 1e-9), 0.5), 2);
    return Math.min(Math.max(this.time + pace * faster * passed, newest - most), newest);
  }

  /* What is shown. */

  /** Shows what has come from the program. */
  update() {
    this.askForPlan();
    if (document.hidden || document.body.dataset.mode !== "play") return;
    this.time = Math.min(this.time, this.run.newest);
    this.isDirty = true;
    this.showState();
    const now = performance.now(), { epoch } = this.run.known, isSetBack = epoch !== this.epoch;
    this.epoch = epoch;
    // The same frame may now have another state.
    if (isSetBack) document.getElementById("digest").textContent = "";
    if (isSetBack || now - this.listed >= Player.LISTING || !this.run.state.playing) {
      this.listed = now;
      this.showTime();
      this.tellEvents();
    }
    if (!isSetBack && now - this.plotted < Player.PLOTTING) return;
    this.plotted = now;
    const shown = this.plots.plots.reduce((sum, plot) => sum + plot.series.length, 0);
    if (this.plots.known.length > shown) this.plots.build();
    else this.plots.draw();
    this.showEnds();
  }

  /** Asks for the plan when a door has opened or closed. */
  async askForPlan() {
    const closed = LiveRun.closedOf(this.run.state.doors);
    this.planned ??= this.run.plans.keys().next().value;
    if (closed === this.planned) return;
    this.planned = closed;
    const found = await this.attempt(() => ask(`runs/${this.run.id}`));
    if (!found) return;
    this.run.keepPlan(found);
    this.showPlan();
  }

  /** The doors at the time that is shown. */
  get doorsShown() {
    return this.isBack ? this.run.doorsAt(this.time) : this.run.state.doors;
  }

  /** Draws the plan with the doors of the time that is shown, if it is known. */
  showPlan() {
    const plan = this.run.plans.get(LiveRun.closedOf(this.doorsShown));
    if (!plan || plan.above === this.scene.above) return;
    Object.assign(this.scene, plan);
    this.plan.isStale = this.isDirty = true;
  }

  /** Shows what depends on the time that is shown, beside the people. */
  showTime() {
    this.showBack();
    this.showPlan();
    this.doors.show(this.doorsShown, this.isBack ? `at ${this.clock}` : "");
  }

  showState() {
    const { state, isConnected, closed } = this.run, $ = id => document.getElementById(id);
    if (this.playing !== state.playing) {
      this.playing = state.playing;
      this.showPlaying();
    }
    const speed = String(state.speed ?? Infinity);
    if ($("speed").value !== speed) $("speed").value = speed;
    const isSlow = state.behind && state.rate !== null;
    const slow = isSlow ? `This speed is too fast: ${shown(state.rate, 2)} × is reached.` : "";
    const fastest = state.playing && state.speed === null && state.rate ? `${shown(state.rate, 1)} ×` : "";
    const end = state.end && !state.playing ? `The run has ended: ${state.end}. Play goes on beyond it.` : "";
    const away = isConnected ? "" : "The program has ended; the page keeps what it has.";
    $("going").textContent = closed || away || state.fault || (state.seeks ? "on the way …" : end || slow || fastest);
    $("going").classList.toggle("wrong", Boolean(closed || away || state.fault));
    this.showBack();
  }

  showBack() {
    const looking = document.getElementById("looking");
    looking.hidden = !this.isBack;
    if (!this.isBack) return;
    const text = `You look at ${this.clock}; the run is at ${this.inDigits(this.run.newest)}`;
    looking.firstElementChild.textContent = text;
  }

  /** The list of what has happened, the newest first, and of warnings. */
  tellEvents() {
    const { events, state } = this.run, list = document.getElementById("events");
    const from = events.lastIndexOf(this.lastEvent) + 1;
    if (from === 0) list.replaceChildren();
    for (const [time, text, isWarning] of events.slice(from).slice(-Player.MOST_EVENTS)) {
      const when = element("b", { textContent: `${shown(time, 2)} s` });
      list.prepend(element("li", { className: isWarning ? "wrong" : "" }, when, ` ${text}`));
    }
    while (list.children.length > Player.MOST_EVENTS) list.lastElementChild.remove();
    this.lastEvent = events.at(-1);
    const warnings = state.warnings.join("\n");
    if (warnings === this.warned) return;
    this.warned = warnings;
    const items = state.warnings.map(text => element("li", { textContent: text }));
    document.getElementById("warnings").replaceChildren(...items);
  }

  /** A time with the digits that the times of frames need. */
  inDigits(time) {
    return `${time.toFixed(this.run.digits)} s`;
  }

  get clock() {
    return this.inDigits(this.time);
  }

  draw() {
    super.draw();
    if (!this.isShown) return;
    if (this.pictures++ === 0) this.focusPlan();
    const own = this.people.person(this.followed), last = this.steps.at(-1);
    if (own && this.time !== last?.time) this.steps.push({ time: this.time, place: own.place });
  }

  /** The path of the last seconds: blocks are shorter than it. */
  trail(pen) {
    this.steps = this.steps.filter(({ time }) => time <= this.time && time >= this.time - TRAIL);
    pen.beginPath();
    for (const { place } of this.steps) pen.lineTo(...this.plan.toScreen(place));
    pen.setLineDash([]);
    pen.lineWidth = 2;
    pen.strokeStyle = "rgba(213, 94, 0, 0.55)";
    pen.stroke();
  }

  overlay(pen) {
    super.overlay(pen);
    this.tools.draw(pen);
  }

  get hasMarks() {
    return super.hasMarks || this.tools.hasMarks;
  }

  get pointed() {
    return this.tools.current.points ? super.pointed : null;
  }

  /* The followed person. */

  follow(id) {
    super.follow(id);
    this.steps = [];
    document.getElementById("own").hidden = id === null;
    document.getElementById("numbers").hidden = true;
    document.getElementById("paced").textContent = "as given";
    this.control({ follow: id });
  }

  /** The forces on everybody are known: nobody is offered. */
  offered() {
    return [];
  }

  /** The preferred speed of the followed person. */
  async setPace(speed) {
    const done = await this.intervene({ set_speed: { agents: [this.followed], preferred_speeds: [speed] } });
    if (done) this.say(`Person ${this.followed} now prefers ${speed} m/s.`);
  }

  async tellAll() {
    const numbers = document.getElementById("numbers");
    const found = await this.attempt(() => ask(`runs/${this.run.id}/person?id=${this.followed}`));
    numbers.hidden = !found;
    numbers.textContent = found ? JSON.stringify(found, null, 2) : "";
  }

  /* Mouse, touch and keys. */

  press(at, isAlone) {
    if (isAlone) this.tools.press(this.plan.toPlan(at));
    else this.tools.cancel();
  }

  drag(to) {
    return this.tools.drag(this.plan.toPlan(to));
  }

  release(isDone) {
    return this.tools.release(isDone);
  }

  focusPlan() {
    document.getElementById("top").focus({ preventScroll: true });
  }

  /** After a click by pointer, keys act on the run again; Tab keeps what it has reached. */
  giveBack({ target, detail }) {
    const clicked = target.closest("button, summary, #time");
    if (!clicked || detail === 0 || document.body.dataset.mode !== "play") return;
    // Arrow keys go on from frame to frame, with every tool.
    if (clicked.closest("#controls")) clicked.blur();
    else this.focusPlan();
  }

  key(event) {
    if (document.body.dataset.mode !== "play" || event.ctrlKey || event.metaKey || event.altKey) return;
    const { tagName } = event.target, isTyping = ["SELECT", "INPUT", "TEXTAREA"].includes(tagName);
    const isPressed = ["BUTTON", "SUMMARY"].includes(tagName) && [" ", "Enter"].includes(event.key);
    if (isTyping && event.key !== "Escape" || isPressed) return;
    if (this.tools.key(event)) event.preventDefault();
    else if (event.key.toLowerCase() === "b") this.goBack(this.time - Player.BACK);
    else super.key(event);
  }
}
