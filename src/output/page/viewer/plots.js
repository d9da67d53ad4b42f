/* Time series, one plot below the other, with the values of the current time. */

/** Round numbers in a range, in at most `most` steps. */
function ticks(low, high, most) {
  const least = (high - low) / most, decade = 10 ** Math.floor(Math.log10(least));
  const step = [1, 2, 5, 10].map(factor => factor * decade).find(step => step >= least * 0.999);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-6); k * step <= high + 1e-6 * step; k++) found.push(k * step);
  return found;
}

/** A number with at most three digits after the point. */
function shown(value, digits = 3) {
  return value === null || value === undefined || Number.isNaN(value)
    ? "–" : String(Number(value.toFixed(value >= 100 ? 0 : digits)));
}

/** An element with attributes and children. */
function element(name, attributes = {}, ...children) {
  const made = Object.assign(document.createElement(name), attributes);
  made.append(...children);
  return made;
}

class Plots {
  static HEIGHT = 116;
  static LEFT = 40;
  static BOTTOM = 18;

  /** Plots of the series of a run; a click calls `seek` with its time. */
  constructor(run, seek) {
    this.run = run;
    this.seek = seek;
    this.build();
  }

  /** The series that have a value. */
  get known() {
    const isKnown = values => values.some(value => value !== null);
    return this.run.scene.series
      .map(([plot, label, color], k) => ({ plot, label, color, values: this.run.series[k] }))
      .filter(one => isKnown(one.values));
  }

  build() {
    this.plots = [];
    const known = this.known, names = [...new Set(known.map(one => one.plot))];
    const place = document.getElementById("plots");
    place.replaceChildren();
    for (const name of names) {
      const series = known.filter(one => one.plot === name);
      const legend = element("div", { className: "legend" });
      for (const one of series) {
        one.value = element("b");
        const mark = element("i");
        mark.style.background = one.color;
        legend.append(element("span", {}, mark, one.label + " ", one.value));
      }
      const canvas = element("canvas"), cursor = element("div", { className: "cursor" });
      const frame = element("div", { className: "frame" }, canvas, cursor);
      place.append(element("figure", {}, element("figcaption", {}, name), legend, frame));
      const move = event => {
        const { left, width } = canvas.getBoundingClientRect();
        const part = (event.clientX - left - Plots.LEFT) / (width - Plots.LEFT);
        const [first, last] = this.ends;
        this.seek(first + Math.min(Math.max(part, 0), 1) * (last - first));
      };
      frame.addEventListener("pointerdown", event => {
        frame.setPointerCapture(event.pointerId);
        move(event);
      });
      frame.addEventListener("pointermove", event => event.buttons && move(event));
      this.plots.push({ name, series, canvas, cursor });
    }
    this.draw();
  }

  get ends() {
    return [this.run.times[0] ?? 0, this.run.times[this.run.last] ?? 0];
  }

  draw() {
    this.plots.forEach(plot => this.drawOne(plot));
  }

  drawOne({ series, canvas }) {
    const { HEIGHT, LEFT, BOTTOM } = Plots, { times } = this.run;
    const ratio = window.devicePixelRatio || 1, width = canvas.parentElement.clientWidth;
    canvas.width = width * ratio;
    canvas.height = HEIGHT * ratio;
    const pen = canvas.getContext("2d");
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    let most = 0;
    for (const one of series) for (const value of one.values) most = Math.max(most, value ?? 0);
    const high = most > 0 ? 1.08 * most : 1, [first, last] = this.ends;
    const x = time => LEFT + (last > first ? (time - first) / (last - first) : 0) * (width - LEFT - 1);
    const y = value => (HEIGHT - BOTTOM) * (1 - value / high) + 0.5;
    pen.font = "11px system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif";
    pen.fillStyle = "#5a6674";
    pen.strokeStyle = "#e4e8ed";
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    pen.beginPath();
    for (const value of ticks(0, high, 4)) {
      pen.moveTo(LEFT, Math.round(y(value)) + 0.5);
      pen.lineTo(width, Math.round(y(value)) + 0.5);
      pen.fillText(shown(value), LEFT - 6, Math.max(y(value), 7));
    }
    pen.stroke();
    pen.textBaseline = "bottom";
    for (const time of ticks(first, last, Math.max(2, width / 90))) {
      const at = x(time), text = `${shown(time)} s`, half = pen.measureText(text).width / 2;
      pen.textAlign = "center";
      pen.fillText(text, Math.min(Math.max(at, LEFT + half), width - half), HEIGHT);
    }
    pen.lineWidth = 1.6;
    pen.lineJoin = "round";
    // More points than pixels would take long to draw and look the same.
    const step = Math.max(1, Math.floor(times.length / (4 * width)));
    for (const one of series) {
      pen.strokeStyle = one.color;
      pen.beginPath();
      let isDown = false;
      for (let k = 0; k < times.length; k += step) {
        const value = one.values[k];
        if (value === null) isDown = false;
        else if (isDown) pen.lineTo(x(times[k]), y(value));
        else pen.moveTo(x(times[k]), y(value));
        isDown = value !== null;
      }
      pen.stroke();
    }
  }

  /** Shows the values of a frame at a time. */
  show(frame, time) {
    const [first, last] = this.ends, part = last > first ? (time - first) / (last - first) : 0;
    for (const { series, canvas, cursor } of this.plots) {
      cursor.style.transform = `translateX(${Plots.LEFT + part * (canvas.clientWidth - Plots.LEFT - 1)}px)`;
      for (const one of series) one.value.textContent = shown(one.values[frame], 2);
    }
  }
}
