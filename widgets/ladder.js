// The ladder with the power flow of the last scan. Python lays it out for the width that there is. An element that is chosen can be
// written and forced, and tells where its device is used.

panels.ladder = (place, layout, page, view) => {
  const { section, body, sub } = frame(place, {
    title: "Ladder",
    sub: layout.about,
    key: "ladder",
    tools: `<button class="tool follow" aria-pressed="true" data-testid="follow" title="Keep the active step in view">${icon("follow")}Follow</button>`,
  });
  body.className = "panel-body scroll ladder-scroll";
  body.setAttribute("role", "group");
  body.setAttribute("aria-label", "Networks");
  const follow = section.querySelector(".follow");
  const follows = () => follow.getAttribute("aria-pressed") === "true";
  follow.hidden = !Object.keys(layout.steps ?? {}).length;
  follow.addEventListener("click", () => {
    set(follow, "aria-pressed", String(!follows()));
    watched = undefined;
    track();
  });
  // Whoever scrolls by hand wants to stay where they are.
  for (const hand of ["wheel", "touchmove"]) body.addEventListener(hand, () => set(follow, "aria-pressed", "false"), { passive: true });

  let drawing;
  let state = {};
  let watched;
  function draw(svg) {
    drawing = new Drawing(body, svg);
    drawing.apply(state);
    [...drawing.svg.querySelectorAll(".net")].forEach((net, row) =>
      [...net.querySelectorAll("[data-position]")].forEach((node, col) => {
        node.dataset.row = row;
        node.dataset.col = col;
        node.setAttribute("tabindex", "-1");
      }),
    );
    const first = drawing.svg.querySelector("[data-position]");
    if (first) first.tabIndex = 0;
    outline = null;
    if (chosen !== null) choose(element(chosen));
    watched = undefined;
    track();
  }
  roving(body, () => [...body.querySelectorAll("[data-position]")]);

  function track() {
    const step = (state.active ?? [])[0];
    if (!drawing || !follows() || !step || step === watched) return;
    watched = step;
    const [unit, network] = layout.steps[step] ?? [];
    const strip = drawing.svg.querySelector(`.net[data-unit="${CSS.escape(unit)}"][data-network="${network}"]`);
    if (strip) body.scrollTop = Math.max(0, strip.getBoundingClientRect().top - body.getBoundingClientRect().top + body.scrollTop - 8);
  }

  // Shows the network of a step; whoever asked for it wants to stay there.
  function reveal(step) {
    set(follow, "aria-pressed", "false");
    const [unit, network] = layout.steps[step] ?? [];
    const strip = drawing?.svg.querySelector(`.net[data-unit="${CSS.escape(unit)}"][data-network="${network}"]`);
    if (!strip) return;
    body.scrollTop = Math.max(0, strip.getBoundingClientRect().top - body.getBoundingClientRect().top + body.scrollTop - 8);
    body.scrollIntoView({ block: "nearest" });
    strip.querySelector("[data-position]")?.focus({ preventScroll: true });
  }

  // -- a chosen element ----------------------------------------------------------------------------------------------

  const plate = platesOf("ladder", page, view);
  let chosen = null; // the position of its instruction
  let outline = null; // around it
  let list = null; // the places where its devices are used
  const element = (position) => drawing?.svg.querySelector(`[data-position="${position}"]`);
  function choose(node) {
    if (!node) return;
    chosen = node.dataset.position;
    if (!outline) {
      outline = document.createElementNS("http://www.w3.org/2000/svg", "rect");
      set(outline, "class", "selected");
      set(outline, "rx", 4);
      set(outline, "pointer-events", "none");
    }
    const box = node.getBBox();
    for (const [name, value] of Object.entries({ x: box.x - 5, y: box.y - 5, width: box.width + 10, height: box.height + 10 })) set(outline, name, value);
    node.parentNode.insertBefore(outline, node.parentNode.firstChild); // below the symbols
  }
  // Boxes have several devices; what they write comes first.
  const asked = (node, heard) => page.request("ladder", "about", { position: Number(node.dataset.position) }, (devices) => devices?.length && heard(devices));
  const change = (node) =>
    asked(node, (devices) => {
      const { label, name, what } = devices.find((each) => each.written) ?? devices[0];
      plate.open(node, { device: label, name, what });
    });
  const uses = (node) =>
    asked(node, (devices) => {
      leave();
      list = document.createElement("div");
      list.className = "plate-pop uses scroll";
      list.dataset.testid = "uses";
      list.setAttribute("role", "dialog");
      list.setAttribute("aria-label", "Used where");
      list.innerHTML = devices
        .map(({ label, name, what, places }) => `
          <p><b class="mono">${escaped(label.split(":")[0])}</b> ${escaped(name)} <span class="dim">${escaped(what)} · used in ${places.length} ${places.length === 1 ? "place" : "places"}</span></p>
          <ul>${places.map(([position, unit, network, step, words]) => `<li><button data-go="${position}"${String(position) === node.dataset.position ? ' aria-current="true"' : ""}><span class="dim">${escaped(unit)}</span> network ${network} <span class="mono dim">step ${step}</span> ${escaped(words)}</button></li>`).join("")}</ul>`)
        .join("");
      view.root.append(list);
      const [spot, root] = [node.getBoundingClientRect(), view.root.getBoundingClientRect()];
      const zoom = root.width / view.root.offsetWidth || 1;
      list.style.left = `${Math.max(4, Math.min((spot.left - root.left) / zoom, view.root.offsetWidth - list.offsetWidth - 4))}px`;
      list.style.top = `${Math.max(4, Math.min((spot.bottom - root.top) / zoom + 6, view.root.offsetHeight - list.offsetHeight - 4))}px`;
      const buttons = [...list.querySelectorAll("button")];
      buttons.forEach((button, at) => {
        button.addEventListener("click", () => go(button.dataset.go));
        button.addEventListener("keydown", (event) => {
          const next = { ArrowDown: buttons[at + 1], ArrowUp: buttons[at - 1] }[event.key];
          if (next) next.focus();
          if (event.key === "ArrowDown" || event.key === "ArrowUp") event.preventDefault();
        });
      });
      list.addEventListener("keydown", (event) => {
        event.stopPropagation();
        if (event.key !== "Escape") return;
        leave();
        element(chosen)?.focus({ preventScroll: true });
      });
      (buttons.find((button) => button.dataset.go !== node.dataset.position) ?? buttons[0])?.focus({ preventScroll: true });
    });
  function leave() {
    list?.remove();
    list = null;
  }
  function go(position) {
    leave();
    set(follow, "aria-pressed", "false");
    const node = element(position);
    if (!node) return;
    choose(node);
    node.scrollIntoView({ block: "center", inline: "nearest" });
    node.focus({ preventScroll: true });
  }
  const at = (event) => event.target.closest?.("[data-position]");
  body.addEventListener("click", (event) => choose(at(event)));
  body.addEventListener("focusin", (event) => choose(at(event)));
  body.addEventListener("dblclick", (event) => at(event) && change(at(event)));
  body.addEventListener("keydown", (event) => {
    const node = at(event);
    if (!node || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "Enter") change(node);
    else if (event.key === "u" || event.key === "U") uses(node);
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
  const outside = (event) => list && !list.contains(event.target) && leave();
  document.addEventListener("pointerdown", outside);

  const sizes = fitting("ladder", body, page);

  return {
    reveal,
    apply(changes, now) {
      state = now;
      if (changes.svg) draw(changes.svg);
      else drawing?.apply(changes);
      plate.show(now);
      if (changes.active) {
        write(sub, changes.active.length ? `${layout.about} · ${changes.active.join(", ")} active` : layout.about);
        track();
      }
    },
    rest(dead) {
      sizes.rest(dead);
      if (dead) plate.close();
      if (dead) leave();
    },
    close() {
      sizes.close();
      plate.end();
      leave();
      document.removeEventListener("pointerdown", outside);
    },
  };
};
