// The ladder with the power flow of the last scan. Python lays it out for the width that there is.

panels.ladder = (place, layout, page) => {
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

  const sizes = fitting("ladder", body, page);

  return {
    reveal,
    apply(changes, now) {
      state = now;
      if (changes.svg) draw(changes.svg);
      else drawing?.apply(changes);
      if (changes.active) {
        write(sub, changes.active.length ? `${layout.about} · ${changes.active.join(", ")} active` : layout.about);
        track();
      }
    },
    rest: sizes.rest,
    close: sizes.close,
  };
};
