/* The plan: floor, walls and names, and the people as discs. */

/** A color `#rrggbb` as a pixel of an image. */
function pixel(color) {
  const value = parseInt(color.slice(1), 16);
  return (255 << 24 | (value & 255) << 16 | value & 0xff00 | value >> 16) >>> 0;
}

/** A pixel with half the brightness. */
function dark(color) {
  return (255 << 24 | color >>> 1 & 0x7f7f7f) >>> 0;
}

/** The colors of a color bar as pixels. */
function pixels(bar) {
  return Uint32Array.from(bar.colors.match(/.{6}/g), color => pixel("#" + color));
}

/** The plan and the people on two canvases: what lies below the people and they themselves, and what lies above. */
class Plan {
  /** The smallest radius of people with a rim, and its width, pixels. */
  static RIMMED = 4.5;
  static RIM = 0.8;
  static FONT = "12px system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif";
  /** The distance between the lines on floors behind exits, pixels. */
  static HATCHED = 8;
  static GRAY = 0xffa29a96;
  /** What lies beside a chosen level, and the margin around it, meters. */
  static FADED = "rgba(252, 252, 249, 0.82)";
  static MARGIN = 1.5;

  constructor(scene) {
    this.scene = scene;
    this.base = document.getElementById("base");
    this.top = document.getElementById("top");
    this.ink = this.base.getContext("2d", { alpha: false, willReadFrequently: true });
    this.pen = this.top.getContext("2d");
    this.above = document.createElement("canvas");
    this.level = null;
    this.fit();
  }

  /** The corners of what is shown: of the chosen level of a building, or of the whole plan. */
  get shown() {
    if (!this.level) return this.scene.shown;
    const [low, high] = this.level[1];
    return [low.map(x => x - Plan.MARGIN), high.map(x => x + Plan.MARGIN)];
  }

  /** Shows the whole plan, or the whole of the chosen level. */
  fit() {
    const [low, high] = this.shown;
    this.center = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
    this.zoom = null;
    this.resize();
  }

  /** The number of pixels of the screen per meter, with which the whole plan is shown. */
  get fitting() {
    const [low, high] = this.shown;
    return 0.95 * Math.min(this.width / (high[0] - low[0]), this.height / (high[1] - low[1]));
  }

  /** Adapts to the size of the window. */
  resize() {
    const { clientWidth, clientHeight } = this.base.parentElement;
    this.ratio = Math.min(window.devicePixelRatio || 1, 2);
    [this.width, this.height] = [clientWidth, clientHeight];
    for (const canvas of [this.base, this.top, this.above]) {
      canvas.width = Math.max(1, Math.round(clientWidth * this.ratio));
      canvas.height = Math.max(1, Math.round(clientHeight * this.ratio));
    }
    this.isStale = true;
  }

  get scale() {
    return this.zoom ?? this.fitting;
  }

  /** A place of the plan on the screen. */
  toScreen([x, y]) {
    return [
      (x - this.center[0]) * this.scale + this.width / 2,
      this.height / 2 - (y - this.center[1]) * this.scale,
    ];
  }

  /** A place on the screen on the plan. */
  toPlan([x, y]) {
    return [
      (x - this.width / 2) / this.scale + this.center[0],
      (this.height / 2 - y) / this.scale + this.center[1],
    ];
  }

  /** Zooms by a factor around a place on the screen. */
  zoomBy(factor, at = [this.width / 2, this.height / 2]) {
    const before = this.toPlan(at);
    this.zoom = Math.min(Math.max(this.scale * factor, this.fitting / 4), 2000);
    const after = this.toPlan(at);
    this.center = [0, 1].map(k => this.center[k] + before[k] - after[k]);
    this.isStale = true;
  }

  /** Moves the plan by pixels of the screen. */
  moveBy(x, y) {
    this.zoom = this.scale;
    this.center = [this.center[0] - x / this.scale, this.center[1] + y / this.scale];
    this.isStale = true;
  }

  /** Draws what does not move, after a change of the view. */
  refresh() {
    if (!this.isStale) return;
    this.isStale = false;
    this.draw(this.ink, this.scene.below);
    for (const floor of this.scene.behind ?? []) this.hatch(this.ink, floor);
    this.ground = new Uint32Array(
      this.ink.getImageData(0, 0, this.base.width, this.base.height).data.buffer);
    this.image = this.ink.createImageData(this.base.width, this.base.height);
    this.buffer = new Uint32Array(this.image.data.buffer);
    const pen = this.above.getContext("2d");
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, this.above.width, this.above.height);
    this.draw(pen, this.scene.above);
  }

  /** Draws marks, names last. */
  draw(pen, marks) {
    pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    pen.lineJoin = "round";
    const path = points => {
      pen.beginPath();
      for (let k = 0; k < points.length; k += 2) {
        pen.lineTo(...this.toScreen([points[k], points[k + 1]]));
      }
    };
    for (const mark of marks) {
      if (mark.area) {
        path(mark.area);
        pen.fillStyle = mark.color;
        pen.fill();
      } else if (mark.line) {
        path(mark.line);
        pen.setLineDash(mark.look.broken ? [5, 4] : []);
        pen.strokeStyle = mark.look.color;
        pen.lineWidth = 1.3 * mark.look.width;
        pen.stroke();
      } else if (mark.dots) {
        pen.setLineDash([]);
        pen.strokeStyle = pen.fillStyle = mark.look.color;
        pen.lineWidth = 1;
        for (let k = 0; k < mark.dots.length; k += 2) {
          const [x, y] = this.toScreen([mark.dots[k], mark.dots[k + 1]]);
          pen.beginPath();
          pen.arc(x, y, 1.1 * mark.look.width, 0, 7);
          if (mark.look.broken) pen.stroke();
          else pen.fill();
        }
      }
    }
    const taken = [];
    for (const mark of marks) if (mark.text) this.name(pen, mark, taken);
  }

  /** Hatches the floor behind an exit or entrance, and says that agents are not counted there, if there is room. */
  hatch(pen, { name, area }) {
    const corners = [];
    for (let k = 0; k < area.length; k += 2) corners.push(this.toScreen([area[k], area[k + 1]]));
    const [left, top] = [0, 1].map(axis => Math.min(...corners.map(corner => corner[axis])));
    const [right, bottom] = [0, 1].map(axis => Math.max(...corners.map(corner => corner[axis])));
    if (right < 0 || bottom < 0 || left > this.width || top > this.height) return;
    pen.save();
    pen.beginPath();
    corners.forEach(corner => pen.lineTo(...corner));
    pen.clip();
    pen.beginPath();
    for (let x = left + top - bottom; x < right; x += Plan.HATCHED) {
      pen.moveTo(x, bottom);
      pen.lineTo(x + bottom - top, top);
    }
    pen.setLineDash([]);
    pen.lineWidth = 1;
    pen.strokeStyle = "rgba(27, 36, 48, 0.12)";
    pen.stroke();
    pen.restore();
    pen.font = Plan.FONT;
    const wide = text => pen.measureText(text).width, room = bottom - top < 20 ? 0 : right - left - 8;
    const text = [`behind ${name}: not counted`, "not counted"].find(text => wide(text) < room);
    if (text) this.text(pen, text, (left + right - wide(text)) / 2, (top + bottom) / 2, "#7d8793");
  }

  /** Writes a name where it covers no other one. */
  name(pen, mark, taken) {
    pen.font = Plan.FONT;
    pen.textBaseline = "middle";
    const width = pen.measureText(mark.text).width, half = 8;
    let [x, y] = this.toScreen(mark.at);
    x += (mark.side[0] - 1) * width / 2 + 3 * mark.side[0];
    y -= mark.side[1] * (half + 1);
    const box = [x - 2, y - half, x + width + 2, y + half];
    const covers = other => box[0] < other[2] && other[0] < box[2] && box[1] < other[3] && other[1] < box[3];
    if (taken.some(covers)) return;
    taken.push(box);
    this.text(pen, mark.text, x, y, mark.color);
  }

  /** Writes a text with a white rim. */
  text(pen, text, x, y, color) {
    pen.font = Plan.FONT;
    pen.textBaseline = "middle";
    pen.lineJoin = "round";
    pen.setLineDash([]);
    pen.lineWidth = 3.5;
    pen.strokeStyle = "rgba(255, 255, 255, 0.85)";
    pen.strokeText(text, x, y);
    pen.fillStyle = color;
    pen.fillText(text, x, y);
  }

  /** Draws people; `people` calls its argument with the place, the radius in meters and the pixel of each. */
  paint(people) {
    this.refresh();
    this.buffer.set(this.ground);
    const { scale, ratio } = this;
    const [left, top] = this.toPlan([0, 0]);
    const size = scale * ratio;
    people((x, y, radius, color) => {
      const [across, down, r] = [(x - left) * size, (top - y) * size, radius * size];
      const rim = r >= Plan.RIMMED * ratio ? Plan.RIM * ratio : 0;
      if (rim) this.disc(across, down, r, dark(color));
      this.disc(across, down, r - rim, color);
    });
    this.ink.putImageData(this.image, 0, 0);
  }

  /** Draws a disc with smooth edges. */
  disc(x, y, r, color) {
    const { buffer } = this, { width, height } = this.image;
    if (x + r < 0 || y + r < 0 || x - r > width || y - r > height) return;
    const outer = (r + 0.5) ** 2, inner = r > 0.5 ? (r - 0.5) ** 2 : 0;
    const last = Math.min(height - 1, Math.floor(y + r + 0.5));
    for (let row = Math.max(0, Math.floor(y - r - 0.5)); row <= last; row++) {
      const dy = (row + 0.5 - y) ** 2;
      if (dy >= outer) continue;
      const half = Math.sqrt(outer - dy);
      const start = row * width;
      const end = start + Math.min(width - 1, Math.floor(x + half - 0.5));
      let at = start + Math.max(0, Math.ceil(x - half - 0.5));
      for (let dx = at - start + 0.5 - x; at <= end; at++, dx++) {
        const distance = dx * dx + dy;
        if (distance <= inner) {
          buffer[at] = color;
          continue;
        }
        const part = Math.min(256, (r + 0.5 - Math.sqrt(distance)) * 256) | 0;
        if (part <= 0) continue;
        const below = buffer[at];
        const even = (color & 0xff00ff) * part + (below & 0xff00ff) * (256 - part);
        const odd = (color >>> 8 & 0xff) * part + (below >>> 8 & 0xff) * (256 - part);
        buffer[at] = (255 << 24 | even >>> 8 & 0xff00ff | odd & 0xff00) >>> 0;
      }
    }
  }

  /** Fades what lies beside the chosen level. */
  fade(pen) {
    const [low, high] = this.shown;
    const [left, bottom] = this.toScreen(low), [right, top] = this.toScreen(high);
    pen.beginPath();
    pen.rect(0, 0, this.width, this.height);
    pen.rect(left, top, right - left, bottom - top);
    pen.fillStyle = Plan.FADED;
    pen.fill("evenodd");
  }

  /** Shows what lies above people, and lets `more` draw on it. */
  cover(more) {
    const pen = this.pen;
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, this.top.width, this.top.height);
    pen.drawImage(this.above, 0, 0);
    pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    if (this.level) this.fade(pen);
    more(pen);
  }
}
