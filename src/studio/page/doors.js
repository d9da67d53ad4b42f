/* The doors of a run that goes on, and the parameters that act while it runs. */

/** A table of exits, doors and entrances with their numbers, and sliders for what can be changed. */
class Doors {
  /** The ends of sliders: people per second, and factors on speeds. */
  static RATES = { min: 0, max: 10, step: 0.1 };
  static FACTORS = { min: 0.05, max: 2, step: 0.05 };

  constructor(player) {
    this.player = player;
    this.rows = new Map();
    const { capacities = [], entrances, zones, areas } = player.run.controls;
    const sliders = [
      // An exit without a limit is at the right end.
      ...capacities.map(({ name, most_per_sec: limit }) => this.slider(`limit of ${name}`, Doors.RATES,
        limit ?? Doors.RATES.max, value => this.limitText(value), value => this.setLimit(name, value))),
      ...entrances.map(name => this.slider(`arrivals at ${name}`, Doors.RATES,
        null, value => `${value} per s`, value => this.change({ set_rate: { entrance: name, per_sec: value } }))),
      ...zones.map(({ name, speed_factor: factor }) => this.slider(`speed in ${name}`, Doors.FACTORS,
        factor, value => `× ${value}`, value => this.change({ set_zone: { zone: name, speed_factor: value } }))),
      ...areas.map(name => this.release(name)),
    ];
    document.getElementById("sliders").replaceChildren(...sliders);
  }

  /** Changes the run, and says so. */
  async change(action, text = "Changed.") {
    if (await this.player.intervene(action)) this.player.say(text);
  }

  limitText(value) {
    return value < Doors.RATES.max ? `${value} per s` : "none";
  }

  setLimit(name, value) {
    const limit = value < Doors.RATES.max ? Math.max(value, Doors.RATES.step) : null;
    return this.change({ set_capacity: { exit: name, most_per_sec: limit } });
  }

  /** A slider with its value in words; a value that is not known is not shown until it is set. */
  slider(name, ends, value, text, does) {
    const input = element("input", { type: "range", ...ends, value: value ?? ends.min, ariaLabel: name });
    input.dataset.name = name;
    const output = element("output", { textContent: value === null ? "as given" : text(value) });
    input.addEventListener("input", () => output.textContent = text(Number(input.value)));
    input.addEventListener("change", () => does(Number(input.value)));
    return element("label", { className: "slider" }, element("span", { textContent: name }), input, output);
  }

  /** A button that ends the waiting in an area. */
  release(name) {
    const button = element("button", { textContent: "Release" });
    button.addEventListener("click", () => this.change({ release: name }, `Nobody waits in ${name} any longer.`));
    return element("p", { className: "slider" }, element("span", { textContent: name }), button);
  }

  /** Shows the numbers of all doors; those of an earlier time, given in words, cannot be opened or closed. */
  show(doors, earlier = "") {
    document.getElementById("doors").hidden = !doors.length;
    Doors.write(document.getElementById("doors-at"), earlier);
    for (const door of doors) {
      const key = `${door.kind} ${door.name}`;
      if (!this.rows.has(key)) this.rows.set(key, this.row(door));
      const { cells, button, row } = this.rows.get(key);
      const numbers = [door.passed ?? "–", door.queue ?? "–", shown(door.flow_per_s, 2)];
      numbers.forEach((number, k) => Doors.write(cells[k], String(number)));
      Doors.write(button, door.open ? "Close" : "Open");
      button.disabled = Boolean(earlier);
      row.classList.toggle("closed", !door.open);
      button.ariaLabel = `${button.textContent} ${key}`;
    }
  }

  /** Sets a text that is not there yet. */
  static write(element, text) {
    if (element.textContent !== text) element.textContent = text;
  }

  row({ name, kind }) {
    const cells = [0, 1, 2].map(() => element("td", { className: "number" }));
    const button = element("button"), title = `${name} (${kind})`;
    const does = () => button.textContent === "Close"
      ? this.change({ close: name }, `${name} is closed.`) : this.change({ open: name }, `${name} is open.`);
    button.addEventListener("click", does);
    const head = element("th", { textContent: title, scope: "row" });
    const row = element("tr", {}, head, ...cells, element("td", {}, button));
    Object.assign(row.dataset, { name, kind });
    document.getElementById("gates").append(row);
    return { cells, button, row };
  }
}
