/* The start page, the modes, and files that are opened and saved. */

class Studio {
  static MODES = { start: "starting", draw: "drawing", play: "playing" };
  static EMPTY = "empty";
  /** The types of files that are images to trace; a plan by CAD can be `image/vnd.dxf`. */
  static IMAGE = /^image\/(png|jpeg|gif|webp|avif)$/;
  /** Where the number of the run that this tab began is kept. */
  static BEGUN = "studio.begun";

  constructor() {
    this.mode = "start";
    this.player = null;
    /** The document that was opened or drawn, if there is one. */
    this.hasDrawing = false;
    const $ = id => document.getElementById(id);
    const on = (id, does) => $(id).addEventListener("click", () => this.attempt(does));
    this.drawing = new Drawing(this);
    for (const mode of ["start", "draw"]) on(`mode-${mode}`, () => this.open(mode));
    on("mode-play", () => this.playDrawn());
    on("start-empty", () => this.drawEmpty());
    on("new-drawing", () => this.drawEmpty());
    on("continue", () => this.open("draw"));
    for (const id of ["start-import", "open-file"]) $(id).addEventListener("click", () => $("file").click());
    $("file").addEventListener("change", event => {
      const files = [...event.target.files];
      if (files.length) this.attempt(() => this.openFiles(files));
      event.target.value = "";
    });
    $("name").addEventListener("change", event => this.rename(event.target.value.trim()));
    for (const button of $("save-kinds").children) {
      button.addEventListener("click", () => this.attempt(() => this.save(button.dataset.kind)));
    }
    addEventListener("click", event => {
      if (!$("save").contains(event.target) || event.target.dataset.kind) $("save").open = false;
    });
    addEventListener("keydown", event => {
      if (event.key === "Escape") $("save").open = false;
    });
    addEventListener("hashchange", () => this.attempt(() => this.follow()));
    this.listenToDrops();
  }

  get document() {
    return this.drawing.document;
  }

  /** Opens what the address or the command line asks for. */
  async begin() {
    document.body.dataset.mode = this.mode;
    this.hasDrawing = this.drawing.restoreStored();
    const { given } = await ask("start");
    if (given && !location.hash) {
      this.take(given);
      if (await this.drawing.play(false)) this.say("Press ▶ or the space bar to play.");
    } else await this.follow();
    document.body.dataset.state = "ready";
  }

  /** Goes where the hash of the address says. */
  async follow() {
    const hash = new URLSearchParams(location.hash.slice(1)), run = hash.get("run");
    if (run !== null) {
      if (String(this.player?.run.id) === run) this.open("play");
      else await this.openRun(run);
    } else if (hash.has("draw") && this.hasDrawing) this.open("draw");
    else await this.open("start", Boolean(location.hash));
  }

  /** Opens a run by its number; without such a run, the start page says so. */
  async openRun(id) {
    try {
      this.player = await Player.open(id);
    } catch (error) {
      await this.open("start");
      this.say(this.words(error), "wrong");
      return;
    }
    this.played = JSON.stringify(this.player.run.document);
    if (!this.hasDrawing) this.take(this.player.run.document);
    this.open("play");
  }

  /** Shows a mode: start, draw or play; the address keeps it. */
  open(mode, isKept = true) {
    // A run that nobody looks at does not go on.
    if (this.mode === "play" && mode !== "play" && this.player?.run.state.playing) this.player.control({ play: false });
    this.mode = mode;
    document.body.dataset.mode = mode;
    for (const [own, section] of Object.entries(Studio.MODES)) {
      document.getElementById(section).hidden = own !== mode;
      document.getElementById(`mode-${own}`).ariaPressed = String(own === mode);
    }
    const hash = mode === "play" ? `#run=${this.player.run.id}` : `#${mode}`;
    // Behind the number of the run, the address may have more, such as a person.
    const isThere = location.hash === hash || location.hash.startsWith(`${hash}&`);
    if (isKept && !isThere) history.pushState(null, "", hash);
    this.placeMessage();
    if (mode === "draw") this.drawing.sheet.resize();
    if (mode === "play") this.player.update();
    this.say("");
    this.showName();
    if (mode === "start") return this.attempt(() => this.showStart());
    return mode === "draw" && !this.hasDrawing ? this.attempt(() => this.drawEmpty()) : null;
  }

  /* The start page. */

  async showStart() {
    const { examples, drawings, runs } = await ask("start"), $ = id => document.getElementById(id);
    const cards = examples.filter(({ name }) => name !== Studio.EMPTY).map(({ name, title, description }) => {
      const card = element("button", { className: "card", id: `example-${name}` },
        element("b", { textContent: title }), element("span", { textContent: description }));
      card.addEventListener("click", () => this.attempt(() => this.playExample(name)));
      return card;
    });
    if (!$("examples").childElementCount) $("examples").append(...cards);
    $("continue").hidden = !this.hasDrawing;
    $("continued").textContent = this.document.name ?? "without a name";
    const others = drawings.filter(({ key }) => key !== this.drawing.key);
    $("kept-drawings").hidden = !others.length;
    $("drawings").replaceChildren(...others.map(kept => this.drawingItem(kept)));
    $("open-runs").hidden = !runs.length;
    $("runs").replaceChildren(...runs.map(run => this.runItem(run)));
  }

  /** A drawing of a tab that was closed, of another one, or one before in this tab. */
  drawingItem({ key, name, elements, age_secs: age }) {
    const link = element("button", { className: "link", textContent: name || "without a name" });
    link.addEventListener("click", () => this.attempt(() => this.continueDrawing(key)));
    const ago = age < 60 ? "less than a minute" : `${Math.round(age / 60)} min`;
    const forget = element("button", { textContent: "Forget", ariaLabel: `forget the drawing ${name ?? ""}` });
    forget.addEventListener("click", () => this.attempt(() => this.forget(key)));
    const about = `${elements} ${elements === 1 ? "element" : "elements"}, changed ${ago} ago`;
    const item = element("li", {}, link, element("span", { className: "soft", textContent: about }), forget);
    item.dataset.drawing = key;
    return item;
  }

  async forget(key) {
    await ask(`drawings/${key}/forget`, {});
    await this.showStart();
  }

  /** Goes on with a drawing of another tab, under a key of its own: that tab may still be open. */
  async continueDrawing(key) {
    const { document } = await ask(`drawings/${key}`);
    this.take(document, { isChanged: true });
    this.open("draw");
    this.drawing.sheet.fit();
    await this.drawing.check();
    await ask(`drawings/${key}/forget`, {});
  }

  runItem({ id, name, state }) {
    const link = element("a", { href: `#run=${id}`, textContent: `${name} (run ${id})` });
    const time = state ? ` at ${shown(state.time, 2)} s, ${state.people} people` : "";
    const close = element("button", { textContent: "Close", ariaLabel: `close run ${id}` });
    close.addEventListener("click", () => this.attempt(() => this.close(id)));
    const item = element("li", {}, link, element("span", { className: "soft", textContent: time }), close);
    item.dataset.run = id;
    return item;
  }

  async close(id) {
    await ask(`runs/${id}/close`, {});
    if (this.player?.run.id === id) {
      this.player.close();
      this.player = null;
    }
    await this.showStart();
  }

  /** Plays an example at once. */
  async playExample(name) {
    const { document } = await ask(`example?name=${encodeURIComponent(name)}`);
    this.take(document);
    await this.play(document);
  }

  /** Draws an empty floor, under a name that no drawing and no run has. */
  async drawEmpty() {
    const [{ document }, { drawings, runs }] = await Promise.all([ask(`example?name=${Studio.EMPTY}`), ask("start")]);
    const taken = new Set([this.document, ...drawings, ...runs].map(({ name }) => name));
    const { name } = document;
    for (let k = 2; taken.has(document.name); k++) document.name = `${name} ${k}`;
    this.drawing.underlay.remove();
    this.edit(document);
  }

  /* Documents. */

  /** Takes a document as the drawing, without showing it. */
  take(document, kept = {}) {
    this.hasDrawing = true;
    this.drawing.open(structuredClone(document), kept);
  }

  /** Draws a document; of the run that is played, as it was given. */
  edit(document) {
    const { run } = this.player ?? {}, done = this.mode === "play" && document === run?.document ? run.state.done : 0;
    this.take(document);
    this.open("draw");
    this.drawing.sheet.fit();
    const changes = done === 1 ? "1 change" : `${done} changes`;
    if (done) this.say(`The drawing is as it was before ${changes} made while it was played; Save in Play keeps them.`);
  }

  /** Plays a document in a new run; throws if the program refuses it. */
  async play(document, isPlaying = true) {
    if (this.isBeginning) return;
    this.isBeginning = true;
    const before = this.player?.run;
    try {
      const { run } = await ask("runs", document);
      await this.openRun(run);
      if (isPlaying && this.mode === "play") this.player.play(true);
      // The run before is forgotten if nothing was done in it: there is room for few. Another tab may have closed it.
      const isOwn = String(before?.id) === sessionStorage.getItem(Studio.BEGUN);
      const isForgotten = isOwn && before.state.done === 0;
      if (isForgotten) await ask(`runs/${before.id}/close`, {}).catch(() => null);
      sessionStorage.setItem(Studio.BEGUN, run);
    } finally {
      this.isBeginning = false;
    }
  }

  /** Shows the run, or begins one if the drawing has changed since. */
  async playDrawn() {
    const isSame = this.mode !== "draw" || JSON.stringify(this.document) === this.played;
    if (this.player && isSame) this.open("play");
    else await this.drawing.play();
  }

  rename(name) {
    this.drawing.change(document => setAt(document, ["name"], name || undefined));
  }

  /** The name of what is shown; the drawing's can be changed. */
  showName() {
    const field = document.getElementById("name"), isDrawn = this.mode === "draw";
    const name = this.mode === "play" ? this.player?.run.name : this.document.name;
    field.hidden = this.mode === "start";
    const run = this.mode === "play" && this.player ? ` (run ${this.player.run.id})` : "";
    document.title = this.mode === "start" ? "sandbox studio" : `${name || "drawing"}${run} – sandbox studio`;
    field.readOnly = !isDrawn;
    if (field !== document.activeElement) field.value = name ?? "";
    for (const button of document.querySelectorAll("#save [data-mode]")) button.hidden = this.mode !== "play";
    document.getElementById("save").hidden = this.mode === "start";
    document.getElementById("mode-play").disabled = !this.player && !this.drawing.shapes.length;
  }

  /* Files. */

  /** Opens files: an image lies beneath the drawing, to be traced. */
  async openFiles(files) {
    const image = files.find(({ type }) => Studio.IMAGE.test(type)), others = files.filter(file => file !== image);
    if (others.length) await this.import(others);
    if (!image) return;
    if (this.mode !== "draw") await this.open("draw");
    this.drawing.underlay.open(image);
  }

  /** Opens a floor plan, or a scenario with the files that it names. */
  async import(files) {
    const names = files.map(({ name }) => name).join(", "), headers = { "Content-Type": "application/octet-stream" };
    this.say(`${names}: reading …`);
    const list = encodeURIComponent(JSON.stringify(files.map(({ name, size }) => [name, size])));
    const answer = await answerOf(`import?files=${list}`, { method: "POST", headers, body: new Blob(files) });
    const { document, notes } = await answer.json();
    this.drawing.underlay.remove();
    this.edit(document);
    this.say(`${[`Opened ${names}`, ...notes.map(note => this.drawing.named(note))].join(". ")}.`);
  }

  /** Files that are dropped anywhere are opened. */
  listenToDrops() {
    const body = document.body;
    addEventListener("dragover", event => {
      event.preventDefault();
      body.classList.add("drops");
    });
    addEventListener("dragleave", event => {
      if (!event.relatedTarget) body.classList.remove("drops");
    });
    addEventListener("drop", event => {
      event.preventDefault();
      body.classList.remove("drops");
      const files = [...event.dataTransfer.files];
      if (files.length) this.attempt(() => this.openFiles(files));
    });
  }

  /** Saves the drawing, or what was played. */
  async save(kind) {
    if (this.mode === "play") {
      await this.player.save(kind);
      return;
    }
    const content = new Blob([`${JSON.stringify(this.document, null, 2)}\n`], { type: "application/json" });
    const name = (this.document.name ?? "drawing").replace(/[\\/:*?"<>|]+/g, "-");
    const address = URL.createObjectURL(content);
    element("a", { href: address, download: `${name}.json` }).click();
    setTimeout(() => URL.revokeObjectURL(address), Player.KEPT);
    this.say(`${name}.json is saved.`);
  }

  /* Messages. */

  /** Does something, and says why it does not work. */
  async attempt(does) {
    try {
      return await does();
    } catch (error) {
      this.say(this.words(error), "wrong");
      if (!(error instanceof Refused)) console.error(error);
      return null;
    }
  }

  /** An error in words. */
  words(error) {
    return error instanceof TypeError ? `The program does not answer (${error.message}).` : error.message;
  }

  /** Puts the message below the header, or onto the plan of the drawing, which would else move with it. */
  placeMessage() {
    const message = document.getElementById("message");
    if (this.mode === "draw") document.getElementById("draw-plan").append(message);
    else document.getElementById("head").after(message);
  }

  /** Shows a message, or none. */
  say(text, kind = "") {
    const message = document.getElementById("message");
    message.textContent = text;
    message.className = kind;
  }
}

addEventListener("DOMContentLoaded", () => {
  globalThis.studio = new Studio();
  globalThis.studio.attempt(() => globalThis.studio.begin());
});
