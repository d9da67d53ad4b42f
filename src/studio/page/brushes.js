/* Tools with a brush: they add and remove people, and give them goals. */

/** A tool with a round brush. */
class BrushTool extends CrowdTool {
  color = "#0b62a4";

  draw(pen, place) {
    const { plan } = this.player;
    pen.beginPath();
    pen.arc(...plan.toScreen(place), this.brush * plan.scale, 0, 7);
    pen.setLineDash([]);
    pen.lineWidth = 2;
    pen.strokeStyle = this.color;
    pen.stroke();
  }
}

/** Adds people of a group. */
class AddTool extends BrushTool {
  /** The distance between people who are added, meters. */
  static SPACING = 0.55;

  hint = "Click or drag to add people where there is room.";

  press(place) {
    if (this.isChoosing) {
      [this.goal, this.isChoosing] = [place, false];
      this.player.say("New people walk to the place that you chose.");
      return;
    }
    this.tried = new Set();
    this.due = [];
    this.count = [0, 0];
    this.from = place;
    this.drag(place);
  }

  drag(place) {
    if (!this.tried) return;
    this.due.push(...this.spots(place));
    if (!this.isBusy) this.send();
  }

  release() {
    this.tried = null;
  }

  cancel() {
    const isBegun = Boolean(this.tried) || this.isChoosing;
    [this.tried, this.isChoosing] = [null, false];
    return isBegun;
  }

  /** The next click chooses the goal of new people. */
  choose() {
    this.isChoosing = true;
    this.player.say("Click the goal of new people.");
  }

  /** The places of a triangular grid within the brush that were not tried since the press. */
  spots([x, y]) {
    const across = AddTool.SPACING, up = across * Math.sqrt(3) / 2, r = this.brush, found = [];
    for (let row = Math.ceil((y - r) / up); row * up <= y + r; row++) {
      const off = row % 2 ? across / 2 : 0, half = Math.sqrt(Math.max(r * r - (row * up - y) ** 2, 0));
      for (let k = Math.ceil((x - half - off) / across); k * across + off <= x + half; k++) {
        found.push([`${row} ${k}`, [k * across + off, row * up]]);
      }
    }
    if (!found.length) found.push([`${x} ${y}`, [x, y]]);
    const isNew = ([key]) => !this.tried.has(key) && this.tried.add(key);
    return found.filter(isNew).map(([, spot]) => spot);
  }

  /** Adds people at the places that are due, until none is left. */
  async send() {
    this.isBusy = true;
    while (this.due.length) {
      const positions = this.due.splice(0).map(spot => this.inScenario(spot));
      const entering = await this.player.attempt(() => this.add(positions));
      if (entering === null) break;
      this.count[0] += entering;
      this.count[1] += positions.length - entering;
      const [entered, full] = this.count, people = entered === 1 ? "person" : "people";
      this.player.say(`${entered} ${people} entered${full ? `, ${full} found no room` : ""}.`);
    }
    this.due = [];
    this.isBusy = false;
  }

  /** Adds people at positions; how many there is room for. */
  async add(positions) {
    const { run } = this.player, group = document.getElementById("group").value;
    const goal = await this.goalOf(run.controls.groups.indexOf(group));
    const add = { group, positions, ...(goal ? { goals: positions.map(() => goal) } : {}) };
    return (await ask(`runs/${run.id}/intervene`, { add })).ids.length;
  }

  /** The goal of new people of a group, by its number, if they need one. */
  async goalOf(group) {
    const { run, people } = this.player;
    if (run.controls.directed[group]) return null;
    if (document.getElementById("goals").value === "chosen") {
      if (!this.goal) throw new Error("Choose the goal of new people first: “choose” in the tool bar.");
      return this.inScenario(this.goal);
    }
    const { block } = people.now;
    let nearest = Infinity, id = null;
    people.each((x, y, row, k) => {
      const away = Math.hypot(x - this.from[0], y - this.from[1]);
      if (block.groups[k] === group && away < nearest) [nearest, id] = [away, block.ids[k]];
    });
    if (id === null) throw new Error("Nobody of this group is here to take the goal from: choose a place as the goal.");
    return (await ask(`runs/${run.id}/person?id=${id}`)).goal;
  }

  draw(pen, place) {
    super.draw(pen, place);
    if (this.goal && document.getElementById("goals").value === "chosen") this.tools.flag(pen, this.goal);
  }
}

/** Removes people: one, or those whom the brush touches. */
class RemoveTool extends BrushTool {
  points = true;
  color = "#b3261e";
  hint = "Click a person, or drag over people, to remove them.";

  press(place) {
    this.from = place;
    this.isBrushing = false;
    this.gone = new Set();
  }

  drag(place) {
    const { plan } = this.player;
    const moved = Math.hypot(place[0] - this.from[0], place[1] - this.from[1]) * plan.scale;
    if (moved < 6 && !this.isBrushing) return;
    if (!this.isBrushing) this.erase(this.within(this.from));
    this.isBrushing = true;
    this.erase(this.within(place));
  }

  release(place) {
    const { people, plan } = this.player;
    const found = !this.isBrushing && people.near(place, NEAR / plan.scale);
    if (found) this.erase([found.id]);
  }

  apply(place) {
    this.gone = new Set();
    this.erase(this.within(place));
  }

  async erase(ids) {
    const remove = ids.filter(id => !this.gone.has(id));
    if (!remove.length) return;
    remove.forEach(id => this.gone.add(id));
    const count = this.gone.size;
    const people = count === 1 ? "person" : "people";
    if (await this.player.intervene({ remove })) this.player.say(`${count} ${people} removed.`);
  }
}

/** Gives people a new goal. */
class GoalTool extends BrushTool {
  points = true;
  chosen = [];
  hint = "Click the new goal of the followed person; else people, then their goal.";

  release(place) {
    const { people, followed } = this.player;
    const isHere = id => people.person(id);
    const agents = (this.chosen.length ? this.chosen : [followed]).filter(isHere);
    if (agents.length) {
      this.chosen = [];
      this.send(agents, place);
      return;
    }
    this.chosen = this.within(place);
    const count = this.chosen.length;
    this.player.say(count ? `${count} chosen: click their goal.` : "Nobody is within the brush.");
  }

  async send(agents, place) {
    const set = { set_goal: { agents, goals: [this.inScenario(place)] } };
    const who = agents.length === 1 ? `Person ${agents[0]} has` : `${agents.length} people have`;
    if (await this.player.intervene(set)) this.player.say(`${who} a new goal.`);
  }

  cancel() {
    const isBegun = this.chosen.length > 0;
    this.chosen = [];
    return isBegun;
  }

  draw(pen, place) {
    const { people, plan, followed } = this.player, chosen = new Set(this.chosen);
    if (followed !== null || chosen.size) this.tools.flag(pen, place);
    else super.draw(pen, place);
    if (!chosen.size) return;
    const { block } = people.now;
    pen.strokeStyle = this.color;
    pen.lineWidth = 1.5;
    people.each((x, y, row, k) => {
      if (!chosen.has(block.ids[k])) return;
      pen.beginPath();
      pen.arc(...plan.toScreen([x, y]), Math.max(people.radius(k) * plan.scale, 3) + 1.5, 0, 7);
      pen.stroke();
    });
  }
}
