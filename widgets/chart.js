// The sequential function chart: active steps lit, what the selected one waits for in words, and the log of steps taken. Python lays
// it out for the width that there is and tells where every step stands; the page tells which bands of the sheet it looks at, those
// near sight too, and gets their drawings and values. Only bands in and near sight are elements of the page.

const ZOOMS = [0.5, 0.67, 0.8, 1, 1.25, 1.5];

panels.chart = (place, layout, page, view) => {
  const tools = `<button class="tool" data-act="hold" data-testid="hold" aria-pressed="false" title="Hold all transitions: the steps stay though conditions are met">${icon("hold")}Hold<span class="more"> transitions</span></button>
    <span class="zoom" role="group" aria-label="Zoom"><button class="tool" data-zoom="-1" data-testid="zoom-out" aria-label="Smaller" title="Smaller (−)">−</button><button class="tool" data-zoom="1" data-testid="zoom-in" aria-label="Larger" title="Larger (+)">+</button></span>
    <button class="tool" data-act="follow" data-testid="chart-follow" aria-pressed="true" title="Keep the active step in view">${icon("follow")}Follow</button>`;
  const { section, body, sub } = frame(place, { title: "Chart", key: "chart", tools });
  body.classList.add("split");
  section.insertAdjacentHTML(
    "beforeend",
    `<footer class="panel-foot"><span class="key"><svg class="ec sfc" width="26" height="20" aria-hidden="true"><g class="step active"><rect class="box" x="1" y="1" width="24" height="18" rx="2"/><circle class="token" cx="13" cy="10" r="3"/></g></svg>active</span><span class="key"><svg class="ec sfc" width="26" height="20" aria-hidden="true"><path class="tbar enabled" d="M1 10H25"/></svg>waits for its condition</span><span class="key"><svg class="ec sfc" width="26" height="20" aria-hidden="true"><path class="tbar" d="M1 10H25"/></svg>its step is not active</span><span class="key">${icon("brk", 14)}breakpoint</span><span class="gap"></span><span><kbd>↑</kbd> <kbd>↓</kbd> <kbd>←</kbd> <kbd>→</kbd> steps <kbd>B</kbd> break <kbd>F</kbd> fire <kbd>−</kbd> <kbd>+</kbd> zoom</span></footer>`,
  );
  body.innerHTML = `
    <div class="main scroll chart-scroll"></div>
    <aside class="side" aria-label="The selected step">
      <h3 class="who"></h3><dl class="facts"></dl>
      <div class="acts">
        <button class="tool" data-act="break" data-testid="break" aria-pressed="false" title="Stop the run when this step begins (B)">${icon("brk")}Break here</button>
        <button class="tool" data-act="network" data-testid="network" title="Show the step's network in the ladder">${icon("eye")}Network</button>
        <button class="tool" data-act="set" data-testid="set-step">Set step</button>
        <button class="tool" data-act="reset" data-testid="reset-step">Reset step</button>
        <span class="fires"></span>
      </div><hr>
      <h3>Steps taken</h3><ol class="log" data-testid="log"></ol>
    </aside>`;
  const main = body.querySelector(".main");
  const [who, facts, log] = [".who", ".facts", ".log"].map((part) => body.querySelector(part));
  const fired = body.querySelector(".fires");
  const boxes = new Map(); // step -> its element, of those that are in the page
  const bands = new Map(); // number from 0 -> { node, markup }, of those that are elements of the page
  const places = Object.keys(layout.steps); // the place of each step among all
  let drawing;
  let sheet = { bands: [], steps: {} }; // from where to where each band reaches; each step's left, top and band; in px
  let state = {};
  let chosen = null; // null follows the active step

  // -- a large chart: scrolled, zoomed, and alive where it is looked at ------------------------------------------------

  const id = Math.random().toString(36).slice(2, 10);
  let zoom = view.chartZoom ?? 1;
  let near = null; // the first and last band of those in and near sight
  let seen = ""; // the bands that Python was told of
  let watched; // the step that was brought into view last
  const followed = section.querySelector('[data-act="follow"]');
  const follows = () => followed.getAttribute("aria-pressed") === "true";
  for (const hand of ["wheel", "touchmove"]) main.addEventListener(hand, () => set(followed, "aria-pressed", "false"), { passive: true });
  function scale() {
    const { width, height } = drawing.svg.viewBox.baseVal;
    set(drawing.svg, "width", width * zoom);
    set(drawing.svg, "height", height * zoom);
    for (const button of section.querySelectorAll("[data-zoom]")) button.disabled = !ZOOMS.includes(zoom) || ZOOMS[ZOOMS.indexOf(zoom) + Number(button.dataset.zoom)] === undefined;
  }
  function magnify(by) {
    const next = ZOOMS[ZOOMS.indexOf(zoom) + by];
    if (next === undefined || !drawing) return;
    const [x, y] = [(main.scrollLeft + main.clientWidth / 2) / zoom, (main.scrollTop + main.clientHeight / 2) / zoom];
    zoom = view.chartZoom = next;
    scale();
    main.scrollTo(x * zoom - main.clientWidth / 2, y * zoom - main.clientHeight / 2);
    soon();
  }
  // The first and last band that reach into some heights of the sheet.
  function reaching(top, bottom) {
    const numbers = sheet.bands.flatMap(([from, to], number) => (to >= top && from <= bottom ? [number] : []));
    return [numbers[0] ?? 0, numbers.at(-1) ?? 0];
  }
  // Tells Python about what is in sight and as much above and below, again as soon as less than half of that is left.
  function look() {
    track();
    const [top, high] = [main.scrollTop / zoom, main.clientHeight / zoom];
    if (!drawing || !high) return;
    const spare = Math.min(high, SPARE_PX / zoom);
    const [first, last] = reaching(top - spare / 2, top + high + spare / 2);
    if (!near || first < near[0] || last > near[1]) {
      near = reaching(top - spare, top + high + spare);
      furnish();
    }
    if (page.dead || seen === String(near)) return;
    seen = String(near);
    page.say("chart", "see", { view: id, first: near[0], last: near[1] });
  }
  const alive = (number) => (state.live ?? []).includes(number); // whether the state has its values
  // Makes elements of the bands in and near sight that are alive, and of no others; what has the focus stays.
  function furnish() {
    if (!near) return;
    const wanted = (number) => number >= near[0] && number <= near[1] && alive(number);
    for (const [number, { node }] of bands) if (!wanted(number) && !node.contains(document.activeElement)) remove(number);
    let fresh = false;
    for (let number = near[0]; number <= near[1]; number++) {
      const markup = wanted(number) && state[`band.${number}`];
      if (!markup || bands.get(number)?.markup === markup) continue;
      add(number, markup);
      fresh = true;
    }
    if (!fresh) return;
    drawing.apply(state);
    mark();
    stop();
  }
  function add(number, markup) {
    remove(number);
    const node = drawing.add(markup, [...bands].filter(([other]) => other > number).sort(([a], [b]) => a - b)[0]?.[1].node);
    drawing.still(node);
    bands.set(number, { node, markup });
    for (const step of node.querySelectorAll(".step")) {
      const device = step.dataset.device;
      const [left, top] = sheet.steps[device];
      boxes.set(device, step);
      Object.assign(step.dataset, { testid: `step-${device}`, row: top, col: left });
      const words = { role: "treeitem", tabindex: "-1", "aria-setsize": places.length, "aria-posinset": places.indexOf(device) + 1 };
      for (const [name, value] of Object.entries(words)) set(step, name, value);
      step.addEventListener("click", () => choose(device));
    }
  }
  function remove(number) {
    const node = bands.get(number)?.node;
    if (!node) return;
    for (const step of node.querySelectorAll(".step")) boxes.delete(step.dataset.device);
    drawing.remove(node);
    bands.delete(number);
  }
  // One stop of Tab: the step that the words at the side are about, else the first in the page.
  function stop() {
    if (main.querySelector('.step[tabindex="0"]')) return;
    const step = boxes.get(shown()) ?? main.querySelector(".step");
    if (step) step.tabIndex = 0;
  }
  const soon = () => work.look(look);
  main.addEventListener("scroll", soon, { passive: true });
  const room = new ResizeObserver(soon);
  room.observe(main);
  function track() {
    const step = (state.active ?? []).find((device) => device in sheet.steps);
    if (!follows() || !step || step === watched || (page.dead && !alive(sheet.steps[step][2]))) return;
    watched = step;
    bring(step);
  }
  // Scrolls until a step can be seen, whether it is in the page or not.
  function bring(step) {
    const [x, y] = sheet.steps[step].map((each) => each * zoom);
    const [wide, high] = [60 * zoom, 44 * zoom];
    if (y < main.scrollTop || y + high > main.scrollTop + main.clientHeight) main.scrollTop = y - (main.clientHeight - high) / 2;
    const left = main.scrollWidth > main.clientWidth ? 0 : (main.clientWidth - drawing.svg.viewBox.baseVal.width * zoom) / 2;
    if (x + left < main.scrollLeft || x + left + wide > main.scrollLeft + main.clientWidth) main.scrollLeft = x - (main.clientWidth - wide) / 2;
  }
  section.querySelector(".zoom").addEventListener("click", (event) => event.target.dataset.zoom && magnify(Number(event.target.dataset.zoom)));

  function draw() {
    const [left, top] = [main.scrollLeft, main.scrollTop];
    const focused = main.contains(document.activeElement) ? document.activeElement.dataset.device : undefined;
    sheet = state.sheet;
    bands.clear();
    boxes.clear();
    drawing = new Drawing(main, sheet.svg);
    set(drawing.svg, "role", "none"); // the tree is around it
    scale();
    main.scrollTo(left, top);
    [near, seen, watched] = [null, "", undefined];
    look();
    boxes.get(focused)?.focus({ preventScroll: true });
  }
  main.setAttribute("role", "tree");
  main.setAttribute("aria-label", "Steps");
  // A step that has the focus may have been scrolled far away: the arrows go on from there.
  main.addEventListener("keydown", (event) => {
    const step = event.target.dataset?.device;
    const band = sheet.steps[step]?.[2];
    if (!event.key.startsWith("Arrow") || !near || band === undefined || (band >= near[0] && band <= near[1])) return;
    bring(step);
    look();
  });
  roving(main, () => [...boxes.values()]);
  main.addEventListener("keydown", (event) => {
    const device = event.target.dataset?.device;
    if (!boxes.has(device) || event.ctrlKey || event.metaKey || event.altKey) return;
    const act = { "+": () => magnify(1), "-": () => magnify(-1), Enter: () => choose(device), b: () => page.say("chart", "break", { step: device }), f: () => page.say("chart", "fire", { step: device }) }[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act) return;
    event.preventDefault();
    event.stopPropagation();
    act();
  });
  const shown = () => chosen ?? (state.active ?? [])[0] ?? Object.keys(layout.steps)[0];
  section.addEventListener("click", (event) => {
    const button = event.target.closest("button[data-act]");
    const step = shown();
    if (!button || !step) return;
    const acts = {
      follow: () => {
        set(followed, "aria-pressed", String(!follows()));
        watched = undefined;
        soon();
      },
      hold: () => page.say("chart", "hold", { on: !state.held }),
      break: () => page.say("chart", "break", { step }),
      network: () => view.parts.ladder?.reveal?.(step),
      set: () => page.say("chart", "step", { step, on: true }),
      reset: () => page.say("chart", "step", { step, on: false }),
      fire: () => page.say("chart", "fire", { step, to: button.dataset.to || null }),
    };
    acts[button.dataset.act]();
  });
  section.querySelector('[data-act="network"]').hidden = !(page.layout.parts ?? []).includes("ladder");
  function choose(device) {
    chosen = chosen === device ? null : device;
    mark();
    explain();
  }
  function mark() {
    const active = state.active ?? [];
    for (const [device, node] of boxes) {
      const now = `${active.includes(device)} ${device === chosen} ${device in (state.breaks ?? {})}`;
      if (node.marked === now) continue;
      node.marked = now;
      const broken = device in (state.breaks ?? {}) ? ", breakpoint" : "";
      const words = `${`${device} ${layout.steps[device].name}`.trim()}${broken}`;
      set(node, "data-on", active.includes(device) ? "" : null);
      set(node, "data-selected", device === chosen ? "" : null);
      set(node, "aria-selected", String(device === chosen));
      set(node, "aria-label", active.includes(device) ? `${words}, active` : words);
    }
  }
  const sizes = fitting("chart", main, page);

  function explain() {
    const active = state.active ?? [];
    const device = chosen ?? active[0] ?? Object.keys(layout.steps)[0];
    if (!device) return;
    const step = layout.steps[device];
    const now = state[`${device}.now`];
    write(who, step.name ? `${device} · ${step.name}` : device);
    const lines = [];
    if (now) lines.push(["active", `<b class="act">${seconds(now.elapsed_us, 2)} s</b> · ${number(now.scans)} ${now.scans === 1 ? "scan" : "scans"}`]);
    else lines.push(["active", "no"]);
    for (const [name, output, on] of now?.outputs ?? step.outputs.map(([name, output]) => [name, output, null]))
      lines.push(["output", `${named(name, output)}${on === null ? "" : on ? ' <b class="on">on</b>' : " off"}`]);
    for (const text of now?.waits ?? []) if (text.length) lines.push(["waits for", text.map(([name, device, words]) => (device ? `${named(name, device)} ${escaped(words)}` : escaped(words))).join("<br>")]);
    const usual = state[`${device}.usual`];
    if (usual) lines.push(["usual", `${seconds(usual[0], 2)} s, ${number(usual[1])} ${usual[1] === 1 ? "time" : "times"}`]);
    if (step.then.length) lines.push(["then", step.then.map((one) => `<span class="mono">${escaped(one)}</span>`).join(" or ")]);
    const [ways, active_now] = [step.ways ?? [], Boolean(now)];
    const fires = ways.map((to) => `<button class="tool" data-act="fire" data-testid="fire-${to.join("-") || "end"}" data-to="${ways.length > 1 ? (to[0] ?? "") : ""}" title="Take this transition now, whether its condition holds or not (F)"${active_now && !page.dead ? "" : " disabled"}>${icon("fire")}Fire → <span class="mono">${escaped(to.join(" ") || "end")}</span></button>`).join("");
    if (fired.dataset.markup !== fires) fired.innerHTML = fired.dataset.markup = fires;
    const breaks = section.querySelector('[data-act="break"]');
    set(breaks, "aria-pressed", String(device in (state.breaks ?? {})));
    for (const button of [breaks, section.querySelector('[data-act="hold"]')]) button.disabled = page.dead;
    for (const [act, off] of [["set", active_now], ["reset", !active_now]]) section.querySelector(`[data-act="${act}"]`).disabled = off || page.dead;
    pieces(facts, lines.flatMap(([word, text]) => [`<dt>${word}</dt>`, `<dd>${text}</dd>`]));
  }

  return {
    apply(changes, now) {
      state = now;
      if (changes.sheet) draw();
      else {
        if (changes.live || Object.keys(changes).some((key) => key.startsWith("band."))) furnish();
        // What is no more told of is out of sight; a step that has the focus there stays as it was.
        drawing?.apply(Object.fromEntries(Object.entries(changes).filter(([, value]) => value !== null)));
      }
      if ("held" in changes) {
        set(section.querySelector('[data-act="hold"]'), "aria-pressed", String(Boolean(state.held)));
        set(section, "data-held", state.held ? "" : null);
      }
      if (changes.breaks) mark();
      if (changes.active) {
        write(sub, `${changes.active.length} of ${Object.keys(layout.steps).length} active`);
        mark();
      }
      if (changes.active || changes.sheet) soon();
      explain();
      if (changes.log)
        pieces(
          log,
          changes.log.map(([time_us, from, to, why]) => `<li><span>${seconds(time_us)}</span><span><span class="mono">${escaped(from && to ? `${from} → ${to}` : to || `${from} ended`)}</span><small>${escaped(why)}</small></span></li>`),
        );
    },
    rest(dead) {
      sizes.rest(dead);
      explain();
      if (!dead) return soon();
      seen = "";
      // Only the bands that were looked at lately are there; opened again, it shows those that were looked at last.
      const [first, last] = reaching(main.scrollTop / zoom, (main.scrollTop + main.clientHeight) / zoom);
      const looked = (state.looked ?? []).filter(alive);
      if (looked.length && !looked.some((number) => number >= first && number <= last)) main.scrollTop = sheet.bands[looked[looked.length >> 1]][0] * zoom;
    },
    close() {
      page.say("chart", "unsee", { view: id });
      work.drop(look);
      room.disconnect();
      sizes.close();
    },
  };
};
