// The sequential function chart: active steps lit, what the selected one waits for in words, and the log of steps taken.

panels.chart = (place, layout, page, view) => {
  const tools = `<button class="tool" data-act="hold" data-testid="hold" aria-pressed="false" title="Hold all transitions: the steps stay though conditions are met">${icon("hold")}Hold<span class="more"> transitions</span></button>`;
  const { section, body, sub } = frame(place, { title: "Chart", key: "chart", tools });
  body.classList.add("split");
  body.innerHTML = `
    <div class="main scroll"></div>
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
  const boxes = new Map(); // step -> its element, for those that are drawn
  let drawing;
  let state = {};
  let chosen = null; // null follows the active step

  function draw(svg) {
    drawing = new Drawing(main, svg).still();
    drawing.apply(state);
    boxes.clear();
    for (const [device, step] of Object.entries(layout.steps)) {
      const node = drawing.find(device);
      if (!node) continue;
      boxes.set(device, node);
      const box = node.querySelector(".box");
      node.dataset.testid = `step-${device}`;
      node.dataset.row = Math.round(box.getAttribute("y"));
      node.dataset.col = Math.round(box.getAttribute("x"));
      node.setAttribute("role", "treeitem");
      node.setAttribute("tabindex", boxes.size === 1 ? "0" : "-1");
      node.addEventListener("click", () => choose(device));
    }
    mark();
  }
  main.setAttribute("role", "tree");
  main.setAttribute("aria-label", "Steps");
  roving(main, () => [...boxes.values()]);
  main.addEventListener("keydown", (event) => {
    const device = event.target.dataset?.device;
    if (!boxes.has(device) || event.ctrlKey || event.metaKey || event.altKey) return;
    const act = { Enter: () => choose(device), b: () => page.say("chart", "break", { step: device }), f: () => page.say("chart", "fire", { step: device }) }[event.key.length === 1 ? event.key.toLowerCase() : event.key];
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
    const markup = lines.map(([word, text]) => `<dt>${word}</dt><dd>${text}</dd>`).join("");
    const [ways, active_now] = [step.ways ?? [], Boolean(now)];
    const fires = ways.map((to) => `<button class="tool" data-act="fire" data-testid="fire-${to.join("-") || "end"}" data-to="${ways.length > 1 ? (to[0] ?? "") : ""}" title="Take this transition now, whether its condition holds or not (F)"${active_now && !page.dead ? "" : " disabled"}>${icon("fire")}Fire → <span class="mono">${escaped(to.join(" ") || "end")}</span></button>`).join("");
    if (fired.dataset.markup !== fires) fired.innerHTML = fired.dataset.markup = fires;
    const breaks = section.querySelector('[data-act="break"]');
    set(breaks, "aria-pressed", String(device in (state.breaks ?? {})));
    for (const button of [breaks, section.querySelector('[data-act="hold"]')]) button.disabled = page.dead;
    for (const [act, off] of [["set", active_now], ["reset", !active_now]]) section.querySelector(`[data-act="${act}"]`).disabled = off || page.dead;
    if (facts.dataset.markup !== markup) facts.innerHTML = facts.dataset.markup = markup;
  }

  return {
    apply(changes, now) {
      state = now;
      if (changes.svg) draw(changes.svg);
      else drawing?.apply(changes);
      if ("held" in changes) {
        set(section.querySelector('[data-act="hold"]'), "aria-pressed", String(Boolean(state.held)));
        set(section, "data-held", state.held ? "" : null);
      }
      if (changes.breaks) mark();
      if (changes.active) {
        write(sub, `${changes.active.length} of ${Object.keys(layout.steps).length} active`);
        mark();
      }
      explain();
      if (changes.log)
        log.innerHTML = changes.log
          .map(([time_us, from, to, why]) => `<li><span>${seconds(time_us)}</span><span><span class="mono">${escaped(from && to ? `${from} → ${to}` : to || `${from} ended`)}</span><small>${escaped(why)}</small></span></li>`)
          .join("");
    },
    rest(dead) {
      sizes.rest(dead);
      explain();
    },
    close: sizes.close,
  };
};
