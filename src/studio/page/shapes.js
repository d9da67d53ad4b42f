/* The geometry of a scenario: which keys have places, and how these are read and changed. */

/**
 * What a scenario can have, by kind: the list with the elements, words for it, its color, and the keys that have
 * places, each with the form in which it gives them (a key `null` means the element itself).
 */
const KINDS = {
  floor: { list: "walkable_area", heading: "Floor", color: "#5a6674", parts: [["rings", null]] },
  obstacle: { list: "obstacles", heading: "Walls and obstacles", color: "#3d4652", parts: [["outline", null]] },
  zone: { list: "zones", heading: "Zones", color: "#8a6d00", parts: [["ring", "area"]] },
  waiting: {
    list: "waiting_areas", heading: "Waiting areas", color: "#7b4ba0", parts: [["ring", "area"], ["point", "facing"]],
  },
  crowd: { list: "crowds", heading: "Crowds", color: "#0b62a4", parts: [["outline", "area"], ["point", "goal"]] },
  grid: { list: "grids", heading: "Grids", color: "#0b62a4", parts: [["box", "min", "max"], ["point", "goal"]] },
  source: { list: "sources", heading: "Sources", color: "#00708f", parts: [["box", "min", "max"], ["point", "goal"]] },
  agent: { list: "agents", heading: "People", color: "#0b62a4", parts: [["point", "position"], ["point", "goal"]] },
  entrance: { list: "entrances", heading: "Entrances", color: "#00708f", parts: [["line", "line"], ["point", "goal"]] },
  exit: { list: "exits", heading: "Exits", color: "#00783f", parts: [["line", "line"]] },
  door: { list: "doors", heading: "Doors", color: "#b35c00", parts: [["line", "line"]] },
  waypoint: { list: "waypoints", heading: "Waypoints", color: "#7b4ba0", parts: [["line", "line"], ["disk", "at"]] },
  queue: { list: "queues", heading: "Queues", color: "#7b4ba0", parts: [["path", "path"]] },
  goal: { heading: "Goal", color: "#00783f", parts: [["point", "goal"]] },
  measurement: {
    list: "measurements", heading: "Measurements", color: "#a3256f", parts: [["corners", "region"], ["line", "line"]],
  },
  label: { list: "labels", heading: "Labels", color: "#5a6674", parts: [["point", "at"]] },
  join: { list: "joins", heading: "Joins of levels", color: "#b35c00", parts: [["line", "line"]] },
  lift: { list: "lifts", heading: "Lifts", color: "#b35c00", parts: [["ring", "cabin"]] },
  journey: { list: "journeys", heading: "Journeys", color: "#5a6674", parts: [] },
  event: { list: "events", heading: "Events", color: "#a33a1d", parts: [["corners", "region"]] },
};
/** The lists whose elements have names that journeys and events refer to. */
const NAMED = ["exits", "doors", "entrances", "waypoints", "waiting_areas", "queues", "zones", "crowds", "journeys"];

/** The value at a list of keys, or nothing. */
function valueAt(value, path) {
  return path.reduce((inner, key) => inner?.[key], value);
}

/** Sets the value at a list of keys, or removes the key if there is none. */
function setAt(value, path, set) {
  const last = path.at(-1);
  let owner = value;
  for (const key of path.slice(0, -1)) owner = owner[key] ??= {};
  if (set !== undefined) owner[last] = set;
  else if (Array.isArray(owner)) owner.splice(last, 1);
  else delete owner[last];
}

/** A path as messages write it, such as `crowds[0].area`. */
function pathText(path) {
  return path.map((key, k) => typeof key === "number" ? `[${key}]` : k ? `.${key}` : key).join("");
}

/** The keys of a path that a message names. */
function pathKeys(text) {
  const isNumber = key => /^\d+$/.test(key);
  return (text.match(/[^.[\]]+/g) ?? []).map(key => isNumber(key) ? Number(key) : key);
}

/** Without the noise of sums, meters. */
function clean(value) {
  return Number(value.toFixed(6));
}

function isPlace(value) {
  return Array.isArray(value) && value.length === 2 && value.every(Number.isFinite);
}

function distance([ax, ay], [bx, by]) {
  return Math.hypot(ax - bx, ay - by);
}

/** The point of a line from `a` to `b` that is nearest to a place. */
function nearestOn([ax, ay], [bx, by], [x, y]) {
  const [dx, dy] = [bx - ax, by - ay], square = dx * dx + dy * dy;
  const part = square > 0 ? Math.min(Math.max(((x - ax) * dx + (y - ay) * dy) / square, 0), 1) : 0;
  return [ax + part * dx, ay + part * dy];
}

/** Twice the signed area of a ring. */
function twiceArea(ring) {
  return ring.reduce((sum, [x, y], k) => {
    const [nx, ny] = ring[(k + 1) % ring.length];
    return sum + x * ny - nx * y;
  }, 0);
}

function isInside(ring, [x, y]) {
  let inside = false;
  ring.forEach(([ax, ay], k) => {
    const [bx, by] = ring[(k + 1) % ring.length];
    if (ay > y !== by > y && x < ax + (y - ay) / (by - ay) * (bx - ax)) inside = !inside;
  });
  return inside;
}

/** The corners of a rectangle, from two opposite ones. */
function rectangle([ax, ay], [bx, by]) {
  return [[ax, ay], [bx, ay], [bx, by], [ax, by]];
}

/** A wall of a thickness around a line. */
function wallAround([ax, ay], [bx, by], thickness) {
  const length = distance([ax, ay], [bx, by]), half = thickness / 2 / length;
  const [nx, ny] = [(ay - by) * half, (bx - ax) * half];
  return [[ax - nx, ay - ny], [bx - nx, by - ny], [bx + nx, by + ny], [ax + nx, ay + ny]]
    .map(place => place.map(toThousandths));
}

/** The rest of a straight wall that opens along a line, and the line in its middle; or nothing if they do not meet. */
function opening(wall, [a, b], near) {
  const isRectangle = wall.length === 4 && wall.every(isPlace);
  if (!isRectangle && !(wall.length === 2 && wall.every(isPlace))) return null;
  const middle = ([px, py], [qx, qy]) => [(px + qx) / 2, (py + qy) / 2];
  const isLong = isRectangle && distance(wall[0], wall[1]) >= distance(wall[1], wall[2]);
  const ring = isRectangle && !isLong ? [wall[1], wall[2], wall[3], wall[0]] : wall;
  const thickness = isRectangle ? distance(ring[1], ring[2]) : 0;
  const [from, to] = isRectangle ? [middle(ring[0], ring[3]), middle(ring[1], ring[2])] : wall;
  const length = distance(from, to), way = [0, 1].map(axis => (to[axis] - from[axis]) / length);
  const along = place => (place[0] - from[0]) * way[0] + (place[1] - from[1]) * way[1];
  const beside = place => Math.abs((place[0] - from[0]) * way[1] - (place[1] - from[1]) * way[0]);
  const [first, last] = [along(a), along(b)].sort((p, q) => p - q);
  const reach = thickness / 2 + Math.max(near, 0.05);
  const isBeside = beside(a) > reach || beside(b) > reach, isBeyond = first < -0.05 || last > length + 0.05;
  if (isBeside || isBeyond || last - first < 0.1) return null;
  const at = part => way.map((x, axis) => toThousandths(from[axis] + part * x));
  const piece = (start, end) => isRectangle ? wallAround(at(start), at(end), thickness) : [at(start), at(end)];
  const walls = [[0, first], [last, length]].filter(([start, end]) => end - start > 0.02).map(ends => piece(...ends));
  return { walls, line: [at(Math.max(first, 0)), at(Math.min(last, length))] };
}

/** The parts of an element as strokes: their points, which are those of the document except in boxes. */
const FORMS = {
  point: (path, value) => isPlace(value) ? [{ path, points: [value], least: 1 }] : [],
  disk: (path, value, element) =>
    isPlace(value) ? [{ path, points: [value], least: 1, radius: element.within ?? 0.5 }] : [],
  line: (path, value) => value?.length === 2 && value.every(isPlace) ? [{ path, points: value, least: 2 }] : [],
  path: (path, value) => value?.every?.(isPlace) ? [{ path, points: value, least: 2, grows: true }] : [],
  ring: (path, value) =>
    value?.every?.(isPlace) ? [{ path, points: value, least: 3, isClosed: true, grows: true }] : [],
  rings: (path, value) => (Array.isArray(value) ? value : [])
    .flatMap((ring, k) => FORMS.ring([...path, k], ring)),
  outline: (path, value) => {
    if (!isPlace(value?.[0])) return FORMS.rings(path, value);
    return value.length === 2 ? FORMS.line(path, value) : FORMS.ring(path, value);
  },
  corners: (path, value) => FORMS.box(path, value?.[0], value?.[1]),
  box: (path, low, high) => isPlace(low) && isPlace(high)
    ? [{ path, points: rectangle(low, high), box: [low, high], least: 4, isClosed: true }] : [],
};

/** An element of a scenario, and where it lies. */
class Shape {
  constructor(document, kind, path, level) {
    Object.assign(this, { kind, path, level: level ?? null });
    this.element = valueAt(document, path);
    /** The levels of a building on which it lies; `null`: all. */
    this.levels = kind === "join" ? this.element?.levels ?? null : level && [level];
    this.text = pathText(path);
    const { heading, color, list } = KINDS[kind];
    Object.assign(this, { heading, color, list });
    this.strokes = KINDS[kind].parts.flatMap(([form, key, other]) => {
      if (kind === "goal" || key === null) return FORMS[form](path, this.element, {});
      if (form === "box") return FORMS.box(path, this.element?.[key], this.element?.[other]);
      return FORMS[form]([...path, key], this.element?.[key], this.element);
    });
  }

  /** The keys of the element that is removed or copied as a whole. */
  get whole() {
    return this.kind === "measurement" ? this.path.slice(0, 2) : this.path;
  }

  /** The name, or else what it is and its number. */
  get name() {
    const { name, text } = this.element ?? {}, number = this.path.findLast(key => typeof key === "number");
    if (this.kind === "measurement") return [this.path[2], name].filter(Boolean).join(" ");
    return name ?? text ?? (this.kind === "goal" ? "goal of all" : `${this.noun} ${number + 1}`);
  }

  get noun() {
    if (this.isWall) return "wall";
    return { waiting: "waiting area", agent: "person" }[this.kind] ?? this.kind;
  }

  /** Whether it is a line, or a rectangle so thin that it is one. */
  get isWall() {
    const { points } = this.strokes[0] ?? {};
    if (this.kind !== "obstacle" || !points || this.strokes.length > 1) return false;
    if (points.length === 2) return true;
    const [long, short] = [[0, 1], [1, 2]].map(([a, b]) => distance(points[a], points[b])).sort((a, b) => b - a);
    return points.length === 4 && short <= 0.5 && long >= 3 * short;
  }

  /** All places of the document in it. */
  get places() {
    return this.strokes.flatMap(({ points, box }) => box ?? points);
  }

  isOn(level) {
    return !level || !this.levels || this.levels.includes(level);
  }

  /** The main part, where it is named. */
  get middle() {
    const { points, isClosed } = this.strokes[0];
    if (!isClosed) return points.length === 2 ? [0, 1].map(axis => (points[0][axis] + points[1][axis]) / 2) : points[0];
    const [low, high] = extent(points);
    return [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
  }

  /** The area within its first ring, square meters. */
  get area() {
    const { points, isClosed } = this.strokes[0] ?? {};
    return isClosed ? Math.abs(twiceArea(points)) / 2 : 0;
  }

  /** Moves all places from where they were in a copy of them. */
  moveFrom(before, [dx, dy]) {
    this.places.forEach((place, k) => {
      place[0] = clean(before[k][0] + dx);
      place[1] = clean(before[k][1] + dy);
    });
  }

  /** What moves a corner of a stroke to a place. */
  grip(stroke, corner) {
    const { points, box } = stroke;
    if (!box) return ([x, y]) => points[corner].splice(0, 2, x, y);
    const fixed = [...points[(corner + 2) % 4]];
    return place => box.forEach((end, k) => {
      const choose = k ? Math.max : Math.min;
      end.splice(0, 2, ...[0, 1].map(axis => choose(fixed[axis], place[axis])));
    });
  }
}

/** The lower left and the upper right corner around places, or nothing. */
function extent(places) {
  if (!places.length) return null;
  const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
  for (const place of places) {
    for (const axis of [0, 1]) {
      low[axis] = Math.min(low[axis], place[axis]);
      high[axis] = Math.max(high[axis], place[axis]);
    }
  }
  return [low, high];
}

/** All elements of a scenario, in the order in which they are drawn. */
function shapesOf(document) {
  const shapes = [], levels = Array.isArray(document.levels) ? document.levels : [];
  const add = (kind, path, level) => shapes.push(new Shape(document, kind, path, level));
  for (const [kind, { list }] of Object.entries(KINDS)) {
    if (kind === "goal" && isPlace(document.goal)) add(kind, ["goal"]);
    const elements = Array.isArray(document[list]) ? document[list] : [];
    elements.forEach((element, k) => {
      const inner = kind === "measurement" ? [Object.keys(element ?? {})[0]] : [];
      add(kind, [list, k, ...inner], inner.length ? element[inner[0]]?.level : element?.level);
    });
    if (kind !== "floor" && kind !== "obstacle") continue;
    levels.forEach((level, k) => {
      const own = Array.isArray(level[list]) ? level[list] : [];
      own.forEach((_, i) => add(kind, ["levels", k, list, i], level.name));
    });
  }
  return shapes;
}

/** A name that no element has yet, such as `exit 2`. */
function newName(document, word) {
  const names = new Set(NAMED.flatMap(list => document[list] ?? []).map(element => element?.name));
  for (let k = 1; ; k++) if (!names.has(`${word} ${k}`)) return `${word} ${k}`;
}

/** Renames a place in journeys and events, which refer to it by name. */
function rename(document, from, to) {
  const swap = name => name === from ? to : name;
  for (const journey of document.journeys ?? []) {
    journey.stages = journey.stages?.map(stage => {
      if (typeof stage === "string") return swap(stage);
      const entries = Object.entries(stage).map(([key, value]) => {
        if (Array.isArray(value)) return [key, value.map(swap)];
        if (key !== "shares") return [key, value];
        return [key, Object.fromEntries(Object.entries(value).map(([name, share]) => [swap(name), share]))];
      });
      return Object.fromEntries(entries);
    });
  }
  for (const event of document.events ?? []) {
    for (const key of ["open", "close", "release"]) if (event[key] === from) event[key] = to;
  }
  for (const list of ["crowds", "grids", "sources", "entrances", "agents"]) {
    for (const group of document[list] ?? []) if (group.journey === from) group.journey = to;
  }
}
