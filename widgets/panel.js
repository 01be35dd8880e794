// What all panels share: the link to the kernel, the frame around a panel, the drawings that only change attributes.
// Every panel's own file adds one function to `panels`. Python puts the files together; there is no build step.
//
//   panels.unit = (place, layout, page) => ({ apply(changes, state), run(run), pulsed(keys), rest(dead) })
//
// `place` is the element to fill, `layout` what Python said once, `page` the link. `apply` gets the entries that have
// changed since it was called last, and the whole state; `run` that of the run itself; `pulsed` the bits that were on between two
// frames; `rest` whether the kernel is gone. They only write: what a panel has to know of sizes and scrolling it finds out by
// `work.look`, or the browser would have to lay out the page in the middle of drawing it.

const panels = {};
const HOLD_MS = 700; // --ec-t-hold: how long a one-scan mark stays
const SILENCE_MS = 2500; // an unanswered question means that there is no kernel
const KEY = "EC0-"; // the prefix of all ids in a drawing as Python sends it; made unique for every view

const escaped = (text) => String(text ?? "").replace(/[&<>"']/g, (sign) => `&#${sign.charCodeAt(0)};`);
const DIGITS = []; // a format of numbers for each count of digits behind the point
const number = (value, digits = 0) =>
  (DIGITS[digits] ??= new Intl.NumberFormat("en-US", { minimumFractionDigits: digits, maximumFractionDigits: digits })).format(Number(value)).replace("-", "−");
const seconds = (us, digits = 3) => number(us / 1e6, digits);

const ICONS = {
  back: '<path class="fill" d="M11.5 3.5v9L5.5 8z"/><path d="M3.75 3.5v9"/>',
  run: '<path class="fill" d="M4.5 2.75v10.5l8.5-5.25z"/>',
  pause: '<path class="fill" d="M4 3h3v10H4zM9 3h3v10H9z"/>',
  scan: '<path class="fill" d="M4.5 3.5v9l6-4.5z"/><path d="M12.25 3.5v9"/>',
  step: '<path class="fill" d="M1.5 4v8l4.5-4z"/><rect x="8.25" y="4.25" width="6" height="7.5"/>',
  brk: '<path class="fill" d="M5.3 1.5h5.4l3.8 3.8v5.4l-3.8 3.8H5.3L1.5 10.7V5.3z"/>',
  hold: '<path d="M8 1.5v4M8 10.5v4M3 8h10M5 5.5h6M5 10.5h6"/>',
  fire: '<path d="M8 1.5v9M3 6h10M5 10.5l3 4 3-4z"/>',
  eye: '<path d="M1.5 8S4 3.75 8 3.75 14.5 8 14.5 8 12 12.25 8 12.25 1.5 8 1.5 8z"/><circle cx="8" cy="8" r="1.75"/>',
  stop: '<rect class="fill" x="3.5" y="3.5" width="9" height="9"/>',
  cross: '<path d="M4 4l8 8M12 4l-8 8"/>',
  unplugged: '<path d="M9.5 3.5l3 3-2 2-3-3zM3.5 9.5l3 3 2-2-3-3zM12 4l2-2M2 14l2-2M7 8l-1 1M8 9l-1 1"/>',
  reset: '<path d="M3.2 8a4.9 4.9 0 1 0 1.6-3.6"/><path d="M3.2 2.2v3.4h3.4"/>',
  find: '<circle cx="7" cy="7" r="4.25"/><path d="M10.25 10.25L14 14"/>',
  follow: '<circle cx="8" cy="8" r="4.25"/><path d="M8 1.5v3M8 11.5v3M1.5 8h3M11.5 8h3"/>',
};
const icon = (name, size = 16) =>
  `<svg class="ico" width="${size}" height="${size}" viewBox="0 0 16 16" aria-hidden="true">${ICONS[name]}</svg>`;

// A device as it is named in words: the variable's name in the text face, its address after it in the code face.
const named = (name, device) => (name ? `${escaped(name)} <span class="mono">${escaped(device)}</span>` : `<span class="mono">${escaped(device)}</span>`);

function set(node, attribute, value) {
  if (value === null || value === undefined || value === false) node.removeAttribute(attribute);
  else if (node.getAttribute(attribute) !== String(value)) node.setAttribute(attribute, value);
}
function write(node, text) {
  const inside = node.firstChild;
  if (inside?.nodeType === Node.TEXT_NODE && inside === node.lastChild) inside.data !== text && (inside.data = text);
  else if (node.textContent !== text) node.textContent = text;
}

// Puts elements into another one, each as markup; those that are there already stay as they are.
function pieces(host, markups) {
  const before = [...host.children];
  const holder = document.createElement("template");
  const nodes = markups.map((markup) => {
    const known = before.findIndex((node) => node.markup === markup);
    if (known >= 0) return before.splice(known, 1)[0];
    holder.innerHTML = markup;
    return Object.assign(holder.content.firstElementChild, { markup });
  });
  for (const node of before) node.remove();
  for (const [at, node] of nodes.entries()) if (host.children[at] !== node) host.insertBefore(node, host.children[at] ?? null);
}

// The work of the page, in one queue, so that a frame of the animation never becomes long. A frame begins with what looks at sizes and
// scrolls, before anything is written; then panels are drawn until DRAW_MS is spent, and those left over come first in the next
// frame. A panel that is out of sight is drawn a few times a second: who scrolls there or has it read aloud finds it as it is.
const [DRAW_MS, AWAY_MS] = [3, 250];
const SPARE_PX = 800; // of a large drawing at most so much above and below what is in sight is there as elements
const work = {
  looks: new Set(),
  draws: new Map(), // what draws -> the element that it draws in
  drawn: new WeakMap(), // what draws -> when it did
  away: new WeakSet(), // the elements that are out of sight
  sights: new IntersectionObserver((seen) => seen.forEach(({ target, isIntersecting }) => work.away[isIntersecting ? "delete" : "add"](target)), { rootMargin: "200px", scrollMargin: "200px" }),
  look(job) {
    this.looks.add(job);
    this.next();
  },
  draw(job, node) {
    if (!this.draws.has(job)) this.draws.set(job, node);
    this.next();
  },
  drop(job) {
    this.looks.delete(job);
    this.draws.delete(job);
  },
  next() {
    clearTimeout(this.later);
    this.frame ??= requestAnimationFrame(() => this.do());
  },
  do() {
    this.frame = undefined;
    const looks = [...this.looks];
    this.looks.clear();
    for (const look of looks) look();
    const began = performance.now();
    let waits = AWAY_MS;
    for (const [job, node] of [...this.draws]) {
      if (performance.now() - began >= DRAW_MS) return this.next();
      const rests = this.away.has(node) ? (this.drawn.get(job) ?? -AWAY_MS) + AWAY_MS - began : 0;
      if (rests > 0) waits = Math.min(waits, rests);
      else if (this.draws.delete(job)) {
        this.drawn.set(job, began);
        job();
      }
    }
    if (this.draws.size && !this.frame) this.later = setTimeout(() => this.next(), waits);
  },
};

// The frame of a panel: title, what it shows, tools, the stamp of the moment.
function frame(place, { title, sub = "", key, tools = "" }) {
  place.innerHTML = `
    <section class="panel" aria-label="${escaped(title)}" data-testid="${key}">
      <header class="panel-head${tools ? " with-tools" : ""}"><h2>${escaped(title)}</h2><span class="sub">${escaped(sub)}</span><span class="gap"></span>${tools}<span class="stamp"></span></header>
      <div class="panel-body"></div>
    </section>`;
  const section = place.firstElementChild;
  return { section, body: section.querySelector(".panel-body"), sub: section.querySelector(".sub") };
}

// A drawing arrives as SVG once; afterwards a frame is "key:attribute" -> value and touches nothing else.
class Drawing {
  static count = 0;
  constructor(host, markup) {
    this.prefix = `ec${++Drawing.count}-`;
    this.known = new Map();
    host.innerHTML = markup.replaceAll(KEY, this.prefix);
    this.svg = host.querySelector("svg");
    for (const node of this.svg.querySelectorAll("[data-testid]")) node.dataset.testid = node.dataset.testid.replace(this.prefix, "");
  }
  find(key) {
    let node = this.known.get(key);
    if (node === undefined) {
      node = this.svg.querySelector(`#${CSS.escape(this.prefix + key)}`);
      this.known.set(key, node);
    }
    return node;
  }
  // A drawing to look at: its symbols cannot be pressed.
  still(part = this.svg) {
    for (const node of part.querySelectorAll("[role=button]")) set(node, "role", "img");
    return this;
  }
  // One more piece of the drawing, before another one or at the end; `remove` takes it out again.
  add(markup, before = null) {
    const holder = document.createElement("template");
    holder.innerHTML = `<svg>${markup.replaceAll(KEY, this.prefix)}</svg>`;
    const node = this.svg.insertBefore(holder.content.firstChild.firstChild, before);
    for (const each of node.querySelectorAll("[id]")) this.known.set(each.id.slice(this.prefix.length), each);
    return node;
  }
  remove(node) {
    for (const each of node.querySelectorAll("[id]")) this.known.delete(each.id.slice(this.prefix.length));
    node.remove();
  }
  apply(changes) {
    for (const [entry, value] of Object.entries(changes)) {
      const cut = entry.lastIndexOf(":");
      if (cut < 0) continue; // an entry of the panel itself
      const node = this.find(entry.slice(0, cut));
      if (!node) continue;
      const attribute = entry.slice(cut + 1);
      if (attribute === "text") write(node, value ?? "");
      else if (attribute === "markup") node.innerHTML = value ?? ""; // escaped by Python
      else set(node, attribute, value);
    }
  }
}

// Tells Python the room that a drawing has, again whenever it changes; Python lays the drawing out for it.
function fitting(part, body, page) {
  let asked;
  const fit = () => {
    const width = 4 * Math.floor((body.clientWidth - 1) / 4);
    if (width <= 0 || width === asked || page.dead) return;
    asked = width;
    page.say(part, "fit", { width });
  };
  const sizes = new ResizeObserver(() => work.look(fit));
  sizes.observe(body);
  return {
    rest(dead) {
      if (dead) asked = undefined;
      else fit();
    },
    close() {
      sizes.disconnect();
      work.drop(fit);
    },
  };
}

// One stop of Tab; the arrows move among `nodes()` inside it. Each node tells its place by data-row and data-col.
function roving(root, nodes) {
  const enter = (node) => {
    for (const other of nodes()) other.tabIndex = other === node ? 0 : -1;
  };
  const first = nodes()[0];
  if (first) enter(first);
  root.addEventListener("focusin", (event) => {
    const node = nodes().find((other) => other === event.target);
    if (node) enter(node);
  });
  root.addEventListener("keydown", (event) => {
    const at = nodes().find((other) => other === event.target);
    const move = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowUp: [-1, 0], ArrowDown: [1, 0], Home: [0, -99], End: [0, 99] }[event.key];
    if (!at || !move || event.ctrlKey || event.metaKey || event.altKey) return;
    const [row, col] = [Number(at.dataset.row), Number(at.dataset.col)];
    const others = nodes().filter((other) => other !== at && other.getClientRects().length);
    const ahead = others.filter((other) =>
      move[0] ? Math.sign(other.dataset.row - row) === move[0] : Number(other.dataset.row) === row && Math.sign(other.dataset.col - col) === Math.sign(move[1]),
    );
    const far = Math.abs(move[1]) > 1 ? -1 : 1;
    const weight = (other) => Math.abs(other.dataset.row - row) * 100 + Math.abs(other.dataset.col - col);
    const next = ahead.sort((a, b) => far * (weight(a) - weight(b)))[0];
    event.preventDefault();
    event.stopPropagation();
    if (next) {
      enter(next);
      next.focus();
    }
  });
}

// The link to the kernel, one for each model in this page and shared by its views: it merges frames, acknowledges
// them, keeps the last state for a view that comes later, and finds out when nobody answers any more.
class Page {
  constructor(model) {
    this.model = model;
    this.layout = model.get("face") ?? {};
    this.state = structuredClone(model.get("last") ?? {});
    this.views = new Set();
    this.requests = new Map(); // what the page has asked for and awaits, by number
    this.dead = false;
    this.heard = performance.now();
    model.on("msg:custom", (message) => this.receive(message));
    model.on("comm_live_update", () => this.ask());
    this.watch = setInterval(() => performance.now() - this.heard > 5000 && this.ask(), 1000);
    this.ask({ hello: true });
  }
  close() {
    clearInterval(this.watch);
    clearTimeout(this.unanswered);
  }
  send(message) {
    try {
      this.model.send(message);
    } catch {
      this.mourn(true); // the comm has gone with its kernel
    }
  }
  say(part, verb, values = {}) {
    if (!this.dead) this.send({ part, do: verb, ...values });
  }
  request(part, verb, values, heard) {
    const asked = Math.random(); // other pages of this model hear the answer too, and do not know the question
    this.requests.set(asked, heard);
    this.say(part, verb, { ...values, asked });
  }
  ask(question = { ping: true }) {
    this.send(question);
    this.unanswered ??= setTimeout(() => this.mourn(true), SILENCE_MS);
  }
  mourn(dead) {
    this.dead = dead;
    for (const view of this.views) view.rest(dead);
  }
  receive(message) {
    this.heard = performance.now();
    clearTimeout(this.unanswered);
    this.unanswered = undefined;
    if (this.dead) {
      this.mourn(false);
      if (!message.full) this.ask({ hello: true });
    }
    if (message.ack) this.send({ ack: message.n });
    if (this.requests.has(message.asked)) {
      this.requests.get(message.asked)(message.answer);
      this.requests.delete(message.asked);
    }
    if (message.layout) {
      this.layout = message.layout;
      this.model.set("face", message.layout);
    }
    if (message.full) this.state = {};
    for (const [part, entries] of Object.entries(message.state ?? {})) {
      const known = (this.state[part] ??= {});
      for (const [key, value] of Object.entries(entries)) value === null ? delete known[key] : (known[key] = value);
    }
    for (const view of this.views) message.layout ? view.build() : view.wait(message);
    // Kept in the page alone, so that a notebook saved with its widgets shows the last state when it is opened again.
    this.model.set("last", this.state);
  }
}

// One place on the page where a page's panels are shown.
class View {
  constructor(page, el) {
    this.page = page;
    this.root = document.createElement("div");
    this.root.className = "ec ec-root";
    this.root.tabIndex = -1;
    set(this.root, "role", "group");
    set(this.root, "aria-label", "PLC");
    this.root.dataset.lmSuppressShortcuts = "true"; // R, N and Space are ours while the focus is here
    this.root.dataset.testid = "ec";
    el.append(this.root);
    this.build();
    this.root.addEventListener("keydown", (event) => this.shortcut(event));
    // JupyterLab's own keys look at the focused node before they come to the root: what has the focus must say so itself.
    this.root.addEventListener("focusin", (event) => (event.target.dataset.lmSuppressShortcuts = "true"));
    page.views.add(this);
  }
  build() {
    const { parts = [], panels: layouts = {} } = this.page.layout;
    this.end();
    this.parts = {};
    this.waiting = {}; // part -> { changes, run, pulses, draw, place }: what has come since it was drawn
    const grid = document.createElement("div");
    grid.className = parts.length > 1 ? "lab" : "alone";
    this.root.replaceChildren(grid);
    for (const part of parts) {
      const place = document.createElement("div");
      place.className = `area area-${part}`;
      grid.append(place);
      this.parts[part] = panels[part](place, layouts[part] ?? {}, this.page, this);
      this.waiting[part] = { draw: () => this.draw(part), place };
      work.sights.observe(place);
    }
    if (parts.length > 1) {
      for (const part of ["chart", "machine"]) set(grid, `data-${part}`, parts.includes(part) ? "" : null);
      this.columns = columns(grid, layouts.ladder?.least);
    }
    this.wait({ state: this.page.state });
    for (const part of parts) this.draw(part);
    this.rest(this.page.dead);
  }
  end() {
    for (const panel of Object.values(this.parts ?? {})) panel.close?.();
    for (const { draw, place } of Object.values(this.waiting ?? {})) {
      work.drop(draw);
      work.sights.unobserve(place);
    }
    this.columns?.();
    this.columns = undefined;
  }
  // What comes now goes on top of what still waits, or takes its place.
  wait({ state = {}, pulsed = {}, full = false }) {
    for (const [part, waits] of Object.entries(this.waiting)) {
      if (state[part]) waits.changes = full ? { ...state[part] } : Object.assign(waits.changes ?? {}, state[part]);
      if (pulsed[part]) waits.pulses = [...new Set([...(waits.pulses ?? []), ...pulsed[part]])];
      waits.run ||= Boolean(state.run);
      if (waits.changes || waits.pulses || (waits.run && this.told(part))) work.draw(waits.draw, waits.place);
    }
  }
  told(part) {
    return this.parts[part].run || this.root.firstElementChild.className === "alone";
  }
  draw(part) {
    const [panel, { state }, waits] = [this.parts[part], this.page, this.waiting[part]];
    const { changes, run, pulses } = waits;
    Object.assign(waits, { changes: undefined, run: false, pulses: undefined });
    if (run) panel.run?.(state.run);
    if (changes) panel.apply(changes, state[part]);
    if (pulses) panel.pulsed?.(pulses);
    if (run) this.stamp();
  }
  rest(dead) {
    set(this.root, "data-dead", dead ? "" : null);
    for (const panel of Object.values(this.parts)) panel.rest?.(dead);
    this.stamp();
  }
  // The moment that is shown; among other panels, where the run control tells it, only of a last state.
  stamp() {
    const run = this.page.state.run;
    if (!run || (!this.page.dead && this.root.firstElementChild.className === "lab")) return;
    const moment = this.page.dead ? `last state · scan ${number(run.scan)}` : `scan ${number(run.scan)} · ${seconds(run.time_us)} s`;
    for (const node of this.root.querySelectorAll(".stamp")) write(node, moment);
  }
  shortcut(event) {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey || event.target.closest("input, textarea")) return;
    if (event.key === " " && event.target.closest("button") && !event.target.closest(".keys")) return; // it presses that button
    const verb = { r: "toggle", R: "toggle", " ": "scan", n: "next_step", N: "next_step", ArrowLeft: "back" }[event.key];
    if (!verb || !this.parts.transport) return;
    event.preventDefault();
    event.stopPropagation();
    this.parts.transport.press(verb);
  }
  close() {
    this.page.views.delete(this);
    this.end();
    this.root.remove();
  }
}

// The lab's columns follow its own width, not the window's: in a cell, beside a notebook, on a wall. The ladder is never
// narrower than its program needs, else its coils would be out of sight. The panels stand in the page as they are read, so
// that Tab goes the same way; on a wide page each of the two columns is read for itself.
const [CHART_PX, GAP_PX, UNIT_PX, SIDE_PX, LADDER_PX] = [344, 16, 776, 520, 476];
const [ACROSS, ASIDE] = [".area-transport", ".area-chart, .area-timers, .area-devices"];
function columns(grid, least = 0) {
  const ladder = Math.max(LADDER_PX, least + 2);
  const areas = [...grid.children];
  const [left, right] = ["lab-a", "lab-b"].map((name) => Object.assign(document.createElement("div"), { className: name }));
  const move = (parent, area) => (grid.isConnected && parent.moveBefore ? parent.moveBefore(area, null) : parent.append(area)); // keeps focus and scroll
  const fit = () => {
    const width = grid.clientWidth;
    const now = width >= UNIT_PX + GAP_PX + SIDE_PX ? "wide" : width >= CHART_PX + GAP_PX + ladder ? "pair" : "one";
    if (now === grid.dataset.columns) return;
    grid.dataset.columns = now;
    if (now === "wide") {
      grid.append(left, right);
      for (const area of areas) if (!area.matches(ACROSS)) move(area.matches(ASIDE) ? right : left, area);
    } else {
      for (const area of areas) move(grid, area);
      for (const column of [left, right]) column.remove();
    }
  };
  const sizes = new ResizeObserver(fit);
  sizes.observe(grid);
  fit();
  return () => sizes.disconnect();
}

const pages = new Map();
export default {
  initialize({ model }) {
    const page = new Page(model);
    pages.set(model.get("page"), page);
    return () => {
      pages.delete(model.get("page"));
      page.close();
    };
  },
  render({ model, el }) {
    const view = new View(pages.get(model.get("page")), el);
    return () => view.close();
  },
};
