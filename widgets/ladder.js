// The ladder with the power flow of the last scan. Python lays it out for the width that there is and tells where every network
// lies; the page tells which networks it looks at, those near sight too, and gets their drawings and values. Drawings of networks
// that it has looked at lately stay in the state; only those in and near sight are elements of the page. An element that is chosen can be written and forced, can have a breakpoint, and tells where its device is used.

panels.ladder = (place, layout, page, view) => {
  const { section, body, sub } = frame(place, {
    title: "Ladder",
    sub: layout.about,
    key: "ladder",
    tools: `<span class="sub where" data-testid="where"></span>
      <label class="ladder-find">${icon("find")}<span class="visually-hidden">Find</span><input type="search" size="9" placeholder="Find" spellcheck="false" autocomplete="off" data-testid="find" title="A device, a name, a program step, a comment (Ctrl F)"></label>
      <button class="tool break" aria-pressed="false" data-testid="ladder-break" title="Stop the run when the chosen element closes or is reached (B)" disabled>${icon("brk")}Break</button>
      <button class="tool follow" aria-pressed="true" data-testid="follow" title="Keep the active step in view">${icon("follow")}Follow</button>`,
  });
  const contact = (state) =>
    `<svg class="ec" width="34" height="20" viewBox="0 0 34 20" aria-hidden="true"><path class="wire${state === "flow" ? " on" : ""}" d="M0 10H10M24 10H34"/><g class="contact ${state}"><rect class="gap" x="10" y="1" width="14" height="18"/><path class="bars" d="M10 1v18M24 1v18"/></g></svg>`;
  section.insertAdjacentHTML(
    "beforeend",
    `<footer class="panel-foot"><span class="key">${contact("open")}open</span><span class="key">${contact("closed")}closed, no power</span><span class="key">${contact("flow")}power flows</span><span class="key"><span class="badge-f">F</span>forced</span><span class="key"><b class="mono bit-on">1</b>bit of a set or reset coil</span><span class="gap"></span><span><kbd>↑</kbd> <kbd>↓</kbd> network <kbd>Enter</kbd> write or force <kbd>U</kbd> where used <kbd>B</kbd> break</span></footer>`,
  );
  body.className = "panel-body scroll ladder-scroll";
  body.setAttribute("role", "group");
  body.setAttribute("aria-label", "Networks");
  const [where, find, breaker, follow] = [".where", ".ladder-find input", ".break", ".follow"].map((part) => section.querySelector(part));
  const follows = () => follow.getAttribute("aria-pressed") === "true";
  const stay = () => set(follow, "aria-pressed", "false");
  follow.hidden = !Object.keys(layout.steps ?? {}).length;
  follow.addEventListener("click", () => {
    set(follow, "aria-pressed", String(!follows()));
    watched = undefined;
    soon();
  });
  // Whoever scrolls by hand wants to stay where they are.
  for (const hand of ["wheel", "touchmove"]) body.addEventListener(hand, stay, { passive: true });

  const id = Math.random().toString(36).slice(2, 10);
  const nets = new Map(); // number from 0 -> { node, markup }, of those that are elements of the page
  let drawing;
  let tops = [0]; // where each network begins, and where the last one ends
  let state = {};
  let [top, high] = [0, 0]; // from where and how much of it is in sight, in px
  let near = null; // the first and last network of those in and near sight
  let seen = ""; // the networks that Python was told of
  let goal = null; // { number, position } to go to as soon as it is drawn
  let watched;
  let refused = ""; // why there is no breakpoint where one was asked for
  let stoppedAt; // the element that was gone to when the run had stopped there

  // -- what is drawn -------------------------------------------------------------------------------------------------

  const count = () => tops.length - 1;
  function numberAt(height) {
    let [low, high] = [0, Math.max(0, count() - 1)];
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (tops[middle] <= height) low = middle;
      else high = middle - 1;
    }
    return low;
  }
  function anchor() {
    const number = numberAt(top);
    return { number, offset: top - tops[number] };
  }
  function draw(sheet) {
    const kept = drawing ? anchor() : view.ladderAt; // a program that was changed is shown where the old one was
    const focused = body.contains(document.activeElement) ? document.activeElement.dataset.position : undefined;
    drawing = new Drawing(body, sheet.svg);
    set(drawing.svg, "role", "group");
    nets.clear();
    tops = sheet.tops;
    outline = null;
    if (kept && kept.number < count()) body.scrollTop = tops[kept.number] + kept.offset;
    [near, seen, watched] = [null, "", undefined];
    look();
    if (focused !== undefined) element(focused)?.focus({ preventScroll: true });
  }
  // Whether the state has the values of a network.
  const within = (number, runs = []) => runs.some((first, at) => at % 2 === 0 && first <= number && number <= runs[at + 1]);
  const alive = (number) => within(number, state.live);
  // Makes elements of the networks in and near sight that are alive, and of no others; what has the focus stays. Says whether there are new ones.
  function furnish() {
    if (!near) return false;
    for (const [number, { node }] of nets)
      if (!(number >= near[0] && number <= near[1] && alive(number)) && !node.contains(document.activeElement)) remove(number);
    let fresh = false;
    for (let number = near[0]; number <= near[1]; number++) {
      const markup = alive(number) && state[`net.${number}`];
      if (!markup || nets.get(number)?.markup === markup) continue;
      add(number, markup);
      fresh = true;
    }
    return fresh;
  }
  function add(number, markup) {
    remove(number);
    const node = drawing.add(markup, [...nets].filter(([other]) => other > number).sort(([a], [b]) => a - b)[0]?.[1].node);
    nets.set(number, { node, markup });
    const title = (node.querySelector(".net-title title") ?? node.querySelector(".net-title"))?.textContent ?? ""; // a shortened one has the whole as its tip
    set(node, "role", "group");
    set(node, "aria-label", `${node.dataset.unit}, network ${Number(node.dataset.network) + 1}${title ? `, ${title}` : ""}`);
    node.dataset.number = number;
    [...node.querySelectorAll("[data-position]")].forEach((each, column) => {
      each.dataset.row = number;
      each.dataset.col = column;
      each.setAttribute("tabindex", "-1");
    });
    if (chosen !== null && node.querySelector(`[data-position="${chosen}"]`)) frameChosen();
  }
  function remove(number) {
    const node = nets.get(number)?.node;
    if (!node) return;
    drawing.remove(node);
    nets.delete(number);
  }
  // One stop of Tab: what is chosen, else the first element that can be seen.
  function stop() {
    if (body.querySelector('[data-position][tabindex="0"]')) return;
    const first = element(chosen) ?? nets.get(numberAt(top))?.node.querySelector("[data-position]") ?? body.querySelector("[data-position]");
    if (first) first.tabIndex = 0;
  }
  roving(body, () => [...body.querySelectorAll("[data-position]")]);

  // Tells Python about what is in sight and as much above and below, again as soon as less than half of that is left.
  function look() {
    track();
    [top, high] = [body.scrollTop, body.clientHeight];
    if (!drawing || !high || !count()) return;
    const first = numberAt(top);
    const spare = Math.min(high, SPARE_PX);
    if (!near || numberAt(top - spare / 2) < near[0] || numberAt(top + high + spare / 2) > near[1]) {
      near = [numberAt(top - spare), numberAt(top + high + spare)];
      if (furnish()) {
        drawing.apply(state);
        mark();
      }
      stop();
    }
    const shown = nets.get(first)?.node;
    write(where, `Network ${number(first + 1)} of ${number(count())}`);
    if (shown) where.title = shown.getAttribute("aria-label");
    view.ladderAt = anchor();
    if (page.dead || seen === String(near)) return;
    seen = String(near);
    page.say("ladder", "see", { view: id, first: near[0], last: near[1] });
  }
  const soon = () => work.look(look);
  body.addEventListener("scroll", soon, { passive: true });
  const room = new ResizeObserver(soon);
  room.observe(body);

  const scrollTo = (number) => (body.scrollTop = Math.max(0, tops[number] - 8));
  function track() {
    const step = (state.active ?? [])[0];
    if (!drawing || !follows() || !step || step === watched || !(step in layout.steps)) return;
    watched = step;
    scrollTo(layout.steps[step]);
  }

  // Shows the network of a step; whoever asked for it wants to stay there.
  function reveal(step) {
    const number = layout.steps[step];
    if (number === undefined) return;
    body.scrollIntoView({ block: "nearest" });
    scrollTo(number);
    go(number, null);
  }

  // Goes to an element, or to the first of a network; if it is not drawn yet, as soon as it is.
  function go(number, position, byHand = true) {
    leave();
    if (byHand) stay();
    goal = { number, position, byHand };
    if (!nets.has(number)) body.scrollTop = (tops[number] + tops[number + 1] - body.clientHeight) / 2;
    look();
    arrive();
  }
  function arrive() {
    const net = goal && nets.get(goal.number);
    if (!net) return;
    const { position, byHand } = goal;
    goal = null;
    const node = position === null ? net.node.querySelector("[data-position]") : element(position);
    if (!node) return;
    choose(node);
    if (!byHand) return bring(node); // the focus stays where somebody works
    if (position !== null) node.scrollIntoView({ block: "center", inline: "nearest" });
    node.focus({ preventScroll: true });
  }
  // Scrolls the panel alone until a node can be seen.
  function bring(node) {
    const [own, outer] = [node.getBoundingClientRect(), body.getBoundingClientRect()];
    if (own.top < outer.top || own.bottom > outer.bottom) body.scrollTop += own.top - outer.top - (outer.height - own.height) / 2;
  }

  // -- a chosen element ----------------------------------------------------------------------------------------------

  const plate = platesOf("ladder", page, view);
  let chosen = null; // the position of its instruction
  let outline = null; // around it
  let list = null; // the places where its devices are used
  const element = (position) => (position === null ? null : drawing?.find(`e${position}`));
  const shape = (name, attributes) => {
    const node = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [attribute, value] of Object.entries(attributes)) set(node, attribute, value);
    return node;
  };
  function frameChosen() {
    const node = element(chosen);
    if (!node) return;
    outline ??= shape("rect", { class: "selected", rx: 4, "pointer-events": "none" });
    const box = node.getBBox();
    for (const [name, value] of Object.entries({ x: box.x - 5, y: box.y - 5, width: box.width + 10, height: box.height + 10 })) set(outline, name, value);
    node.parentNode.insertBefore(outline, node.parentNode.firstChild); // below the symbols
  }
  function choose(node) {
    if (!node) return;
    chosen = node.dataset.position;
    refused = "";
    frameChosen();
    tell();
  }

  // -- breakpoints: an octagon at the element, hollow when it is switched off, ringed where the run has stopped ----------

  function mark() {
    for (const node of body.querySelectorAll(".break-mark")) node.remove();
    for (const [position, kind] of Object.entries(state.breaks ?? {})) {
      const node = element(position);
      const symbol = node?.querySelector(".bars, .frame, .box");
      if (!symbol) continue;
      const box = symbol.getBBox();
      const octagon = shape("path", { class: `break-mark breakpoint ${kind}`, "pointer-events": "none", d: `M${box.x - 11} ${box.y - 7}h5.8l4.1 4.1v5.8l-4.1 4.1h-5.8l-4.1 -4.1v-5.8z` });
      node.parentNode.append(octagon);
    }
    tell();
  }
  function tell() {
    const stopped = Object.entries(state.breaks ?? {}).find(([, kind]) => kind === "hit")?.[0];
    const active = state.active ?? [];
    const words = refused || (stopped ? `stopped at ${element(stopped)?.dataset.device ?? "a breakpoint"}` : active.length ? `${layout.about} · ${active.join(", ")} active` : layout.about);
    write(sub, words);
    sub.title = words;
    set(sub, "role", refused ? "alert" : null);
    set(breaker, "aria-pressed", String(chosen in (state.breaks ?? {})));
    breaker.disabled = page.dead || chosen === null;
  }
  const toggle = () =>
    page.request("ladder", "break", { position: Number(chosen) }, (reason) => {
      refused = reason ?? "";
      tell();
    });
  breaker.addEventListener("click", toggle);

  // -- its devices, and what is looked for -----------------------------------------------------------------------------

  // Boxes have several devices; what they write comes first.
  const asked = (node, heard) => page.request("ladder", "about", { position: Number(node.dataset.position) }, (devices) => devices?.length && heard(devices));
  const change = (node) =>
    asked(node, (devices) => {
      const { label, name, what } = devices.find((each) => each.written) ?? devices[0];
      plate.open(node, { device: label, name, what });
    });
  const rows = (places, here) =>
    `<ul>${places.map(([number, position, unit, network, step, words]) => `<li><button data-number="${number}" data-go="${position}"${String(position) === here ? ' aria-current="true"' : ""}><span class="dim">${escaped(unit)}</span> network ${network} <span class="mono dim">step ${step}</span> ${escaped(words)}</button></li>`).join("")}</ul>`;
  function show(anchor, label, markup, back) {
    leave();
    list = document.createElement("div");
    list.className = "plate-pop uses scroll";
    list.dataset.testid = "uses";
    list.setAttribute("role", "dialog");
    list.setAttribute("aria-label", label);
    list.innerHTML = markup;
    view.root.append(list);
    const [spot, root] = [anchor.getBoundingClientRect(), view.root.getBoundingClientRect()];
    const zoom = root.width / view.root.offsetWidth || 1;
    list.style.left = `${Math.max(4, Math.min((spot.left - root.left) / zoom, view.root.offsetWidth - list.offsetWidth - 4))}px`;
    list.style.top = `${Math.max(4, Math.min((spot.bottom - root.top) / zoom + 6, view.root.offsetHeight - list.offsetHeight - 4))}px`;
    const buttons = [...list.querySelectorAll("button")];
    buttons.forEach((button, at) => {
      button.addEventListener("click", () => go(Number(button.dataset.number), button.dataset.go));
      button.addEventListener("keydown", (event) => {
        const next = { ArrowDown: buttons[at + 1], ArrowUp: buttons[at - 1] ?? (back === find ? find : undefined) }[event.key];
        if (next) next.focus();
        if (event.key === "ArrowDown" || event.key === "ArrowUp") event.preventDefault();
      });
    });
    list.addEventListener("keydown", (event) => {
      event.stopPropagation();
      if (event.key !== "Escape") return;
      leave();
      (back === find ? find : element(chosen))?.focus({ preventScroll: true });
    });
    return buttons;
  }
  const uses = (node) =>
    asked(node, (devices) => {
      const here = node.dataset.position;
      const markup = devices
        .map(({ label, name, what, places }) => `
          <p><b class="mono">${escaped(label.split(":")[0])}</b> ${escaped(name)} <span class="dim">${escaped(what)} · used in ${places.length} ${places.length === 1 ? "place" : "places"}</span></p>${rows(places, here)}`)
        .join("");
      const buttons = show(node, "Used where", markup, node);
      (buttons.find((button) => button.dataset.go !== here) ?? buttons[0])?.focus({ preventScroll: true });
    });
  function search() {
    const text = find.value;
    if (!text.trim()) return leave();
    page.request("ladder", "find", { text }, (places) => {
      if (find.value !== text || document.activeElement !== find) return;
      const found = places.length ? `${places.length} ${places.length === 1 ? "place" : "places"}` : "nothing in this program";
      show(find, "Found", `<p><b>${escaped(text)}</b> <span class="dim" role="status">${found}</span></p>${rows(places)}`, find);
    });
  }
  find.addEventListener("input", search);
  find.addEventListener("keydown", (event) => {
    event.stopPropagation();
    const first = list?.querySelector("button");
    if (event.key === "Escape") leave();
    else if (event.key === "Enter" && first) first.click();
    else if (event.key === "Enter") search();
    else if (event.key === "ArrowDown" && first) first.focus();
    else return;
    event.preventDefault();
  });
  function leave() {
    list?.remove();
    list = null;
  }

  const at = (event) => event.target.closest?.("[data-position]");
  body.addEventListener("click", (event) => choose(at(event)));
  body.addEventListener("focusin", (event) => choose(at(event)));
  body.addEventListener("dblclick", (event) => at(event) && change(at(event)));
  section.addEventListener("keydown", (event) => {
    if ((event.ctrlKey || event.metaKey) && !event.altKey && event.key.toLowerCase() === "f") find.select();
    else if (event.ctrlKey || event.metaKey || event.altKey || !at(event)) return;
    else if (event.key === "Enter") change(at(event));
    else if (event.key.toLowerCase() === "u") uses(at(event));
    else if (event.key.toLowerCase() === "b") toggle();
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
  const outside = (event) => list && !list.contains(event.target) && event.target !== find && leave();
  document.addEventListener("pointerdown", outside);

  const sizes = fitting("ladder", body, page);

  return {
    reveal,
    apply(changes, now) {
      state = now;
      if (changes.sheet) draw(changes.sheet);
      const others = Object.keys(changes).some((key) => key === "live" || key.startsWith("net."));
      const fresh = (others && furnish()) || changes.sheet;
      drawing?.apply(fresh ? now : changes);
      if (fresh || changes.breaks || changes.active) mark();
      plate.show(now);
      if (changes.active) soon();
      if (changes.hit && String(changes.hit) !== stoppedAt) go(...changes.hit, false);
      if ("hit" in changes) stoppedAt = String(changes.hit);
      if (others) stop();
      arrive();
    },
    rest(dead) {
      sizes.rest(dead);
      find.disabled = dead;
      tell();
      if (!dead) return soon();
      plate.close();
      leave();
      seen = "";
      // Only the networks that were looked at lately are there; opened again, it shows those that were looked at last.
      const there = Array.from({ length: count() }, (_, number) => number).filter((number) => within(number, state.looked));
      const [first, last] = [numberAt(body.scrollTop), numberAt(body.scrollTop + body.clientHeight)];
      if (there.length && !there.some((number) => number >= first && number <= last)) body.scrollTop = tops[there[there.length >> 1]] - body.clientHeight / 2;
    },
    close() {
      page.say("ladder", "unsee", { view: id });
      work.drop(look);
      sizes.close();
      room.disconnect();
      plate.end();
      leave();
      document.removeEventListener("pointerdown", outside);
    },
  };
};
