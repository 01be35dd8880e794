// Timers and counters in use, and the time of the active steps: value, preset, a bar, the state in words.

const TALL = 30; // so many rows are in sight at once

panels.timers = (place, layout, page) => {
  const { rows = [], timers = 0, counters = 0 } = layout;
  const { body } = frame(place, { title: "Timers and counters", sub: `${rows.length} in use`, key: "timers", tools: '<button class="tool" data-testid="seconds" aria-pressed="false" title="Values and presets of timers in seconds">Seconds</button>' });
  const tool = place.querySelector("[data-testid=seconds]");
  tool.hidden = !rows.some((one) => one.base_us);
  let inSeconds = false;
  let state = {};
  // A timer's value as it stands, or in seconds, as precise as its time unit.
  const amount = (one, value) => (inSeconds && one.base_us ? `${seconds(value * one.base_us, { 100000: 1, 10000: 2 }[one.base_us] ?? 3)} s` : number(value));
  const contact = `<svg class="ec mini" width="30" height="20" viewBox="0 0 30 20" role="img"><path class="wire" d="M0 10H9M21 10H30"/><g class="contact open"><rect class="gap" x="9" y="1" width="12" height="18"/><path class="bars" d="M9 1v18M21 1v18"/></g></svg>`;
  const step = `<svg class="ec mini" width="30" height="20" viewBox="0 0 30 20" aria-hidden="true"><g class="step active"><rect class="box" x="2" y="1" width="26" height="18" rx="2"/><circle class="token" cx="15" cy="10" r="3"/></g></svg>`;
  const gauge = (kind = "") =>
    `<svg class="gauge ${kind}" width="100%" height="18" viewBox="0 0 300 18" preserveAspectRatio="none" aria-hidden="true"><g class="track"></g><g class="fill"></g><path class="zero" d=""/><path class="goal" d=""/></svg>`;
  const row = (one) => `
    <tr data-device="${one.device}" data-testid="row-${one.device}" data-state="off">
      <td>${contact}</td><td class="mono dev">${one.device}</td><td class="nm" title="${escaped(one.name)}">${escaped(one.name)}</td><td class="mono dim kind">${one.kind}</td>
      <td class="num val"><b data-testid="${one.device}">0</b></td><td class="num dim preset"${one.base ? ` data-base="${escaped(one.base)}"` : ""}></td><td class="bar">${gauge()}</td>
      <td class="num dim base">${escaped(one.base)}</td><td class="say"></td><td class="mono dim used">${escaped(one.steps)}</td></tr>`;
  const group = (word, about) => `<tr class="group"><th colspan="10" scope="rowgroup">${word} <span>${about}</span></th></tr>`;
  const of = (kind, total) => {
    const list = rows.filter((one) => one.unit === kind);
    return list.length ? group(kind === "timer" ? "Timers" : "Counters", `${list.length} of ${total} used`) + list.map(row).join("") : "";
  };
  body.innerHTML = `
    <table class="grid timers"><thead><tr><th><span class="visually-hidden">Contact</span></th><th>Device</th><th>Name</th><th class="kind">Kind</th><th class="num">Value</th><th class="num">Preset</th><th></th><th class="num base">Base</th><th>State</th><th class="used">Steps</th></tr></thead>
      <tbody>${of("timer", timers)}${of("counter", counters)}</tbody><tbody class="steps"></tbody></table>`;
  body.classList.add("scroll", "timers-scroll");
  if (rows.length > TALL) body.tabIndex = 0; // to be scrolled by key
  if (!rows.length && !layout.sfc) body.innerHTML = '<p class="nothing">The program uses no timers and no counters.</p>';
  const found = (line) => Object.fromEntries(
    Object.entries({ value: ".val b", preset: ".preset", contact: ".contact", wire: ".wire", mini: ".mini", say: ".say", gauge: ".gauge", track: ".track", fill: ".fill", goal: ".goal", zero: ".zero" }).map(([name, selector]) => [name, line.querySelector(selector)]),
  );
  // A row is drawn for itself, so that many of them do not hold up a frame, and those out of sight not those in sight.
  const drawn = new Map(
    rows.map((one) => {
      const line = body.querySelector(`tr[data-device="${one.device}"]`);
      const nodes = found(line);
      work.sights.observe(line);
      return [one.device, { line, draw: () => show(one, line, nodes) }];
    }),
  );

  // A bar of 300: in segments for a small preset, from the middle for what counts both ways, else as long as what has passed.
  function draw({ gauge, track, fill, goal, zero }, value, preset, segments, twoSided) {
    const shape = `${preset}/${segments}/${twoSided}`;
    const cells = segments && preset > 0 && preset <= 20 ? preset : 1;
    const pitch = 300 / cells;
    const part = (at, from, to, thick) => `<rect x="${(at * pitch + from).toFixed(1)}" y="${9 - thick / 2}" width="${Math.max(0, to - from).toFixed(1)}" height="${thick}"/>`;
    const bar = (x, width) => {
      set(fill.firstChild, "x", x.toFixed(1));
      set(fill.firstChild, "width", width.toFixed(1));
    };
    if (gauge.dataset.shape !== shape) {
      gauge.dataset.shape = shape;
      const gap = cells > 1 ? 3 : 0;
      track.innerHTML = Array.from({ length: cells }, (_, at) => part(at, 0, pitch - gap, 6)).join("");
      fill.innerHTML = cells > 1 ? "" : part(0, 0, 0, 8);
      set(goal, "d", cells > 1 ? "" : twoSided ? `M${150 + 120 * Math.sign(preset)} 1v16` : "M299 1v16");
      set(zero, "d", twoSided ? "M150 1v16" : "");
    }
    if (cells > 1) {
      const full = Math.min(cells, Math.max(0, value));
      while (fill.children.length > full) fill.lastChild.remove();
      if (fill.children.length < full) fill.innerHTML = Array.from({ length: full }, (_, at) => part(at, 0, pitch - 3, 8)).join("");
    } else if (twoSided) {
      const at = Math.max(-150, Math.min(150, (120 * value) / Math.abs(preset || 1)));
      bar(Math.min(150, 150 + at), Math.abs(at));
    } else {
      bar(0, preset > 0 ? Math.max(0, Math.min(1, value / preset)) * 300 : 0);
    }
  }

  // Words of which those between two stars are bold.
  function tell(node, words) {
    const parts = words.split("*");
    if (node.childNodes.length !== parts.length) node.replaceChildren(...parts.map((_, at) => (at % 2 ? document.createElement("b") : document.createTextNode(""))));
    parts.forEach((text, at) => write(node.childNodes[at], text));
  }

  function show(one, line, nodes) {
    const value = state[one.device] ?? 0;
    const preset = state[`${one.device}.preset`] ?? 0;
    const on = state[`${one.device}.on`];
    set(line, "data-state", state[`${one.device}.is`] ?? "off");
    write(nodes.value, amount(one, value));
    write(nodes.preset, amount(one, preset));
    set(nodes.contact, "class", on ? "contact flow" : "contact open");
    set(nodes.wire, "class", on ? "wire on" : "wire");
    set(nodes.mini, "aria-label", on ? "contact closed" : "contact open");
    set(nodes.mini, "data-on", on ? "" : null);
    draw(nodes, value, preset, one.unit === "counter", one.signed);
    tell(nodes.say, state[`${one.device}.say`] ?? "");
  }

  function active(steps) {
    const tail = body.querySelector(".steps");
    if (!tail) return;
    const shape = steps.map(([device]) => device).join(" ");
    if (tail.dataset.shape !== shape) {
      tail.dataset.shape = shape;
      tail.innerHTML =
        group("Active steps", steps.length ? "time in the step, against the usual time" : "none") +
        steps.map(([device, name, , , , used]) => `
          <tr data-device="${device}"><td>${step}</td><td class="mono dev">${device}</td><td class="nm" title="${escaped(name)}">${escaped(name)}</td><td class="mono dim kind">STL</td>
          <td class="num val"><b></b></td><td class="num dim preset"></td><td class="bar">${gauge("step")}</td><td class="num dim base">s</td><td class="say"><span class="scans"></span><span class="usual"></span></td><td class="mono dim used">${escaped(used)}</td></tr>`).join("");
    }
    for (const [device, , elapsed_us, usual_us, scans] of steps) {
      const line = tail.querySelector(`tr[data-device="${device}"]`);
      write(line.querySelector(".val b"), seconds(elapsed_us, 2));
      write(line.querySelector(".preset"), usual_us ? seconds(usual_us, 2) : "");
      draw(found(line), elapsed_us, usual_us ?? 0, false, false);
      set(line.querySelector(".goal"), "class", "goal soft");
      set(line.querySelector(".goal"), "d", usual_us ? "M299 1v16" : "");
      write(line.querySelector(".scans"), `${number(scans)} ${scans === 1 ? "scan" : "scans"}`);
      write(line.querySelector(".usual"), usual_us ? `, usually ${seconds(usual_us, 2)} s` : "");
    }
  }

  tool.addEventListener("click", () => {
    inSeconds = !inSeconds;
    set(tool, "aria-pressed", String(inSeconds));
    set(body.querySelector(".grid"), "data-seconds", inSeconds ? "" : null);
    for (const { draw } of drawn.values()) draw();
  });

  return {
    apply(changes, now) {
      state = now;
      const touched = new Set(Object.keys(changes).map((key) => key.split(".")[0]));
      for (const [device, { line, draw }] of drawn) if (touched.has(device)) work.draw(draw, line);
      if (changes.steps) active(changes.steps);
    },
    close() {
      for (const { line, draw } of drawn.values()) {
        work.drop(draw);
        work.sights.unobserve(line);
      }
    },
  };
};
