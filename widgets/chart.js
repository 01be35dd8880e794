// The sequential function chart: active steps lit, what the selected one waits for in words, and the log of steps taken.

panels.chart = (place, layout, page) => {
  const { section, body, sub } = frame(place, { title: "Chart", sub: layout.about, key: "chart" });
  body.classList.add("split");
  body.innerHTML = `
    <div class="main scroll"></div>
    <aside class="side" aria-label="The selected step">
      <h3 class="who"></h3><dl class="facts"></dl><hr>
      <h3>Steps taken</h3><ol class="log" data-testid="log"></ol>
    </aside>`;
  const drawing = new Drawing(body.querySelector(".main"), layout.svg);
  const [who, facts, log] = [".who", ".facts", ".log"].map((part) => body.querySelector(part));
  let state = {};
  let chosen = null; // null follows the active step

  const boxes = new Map(); // step -> its element, for those that are drawn
  for (const [device, step] of Object.entries(layout.steps)) {
    const node = drawing.find(device);
    if (!node) continue;
    boxes.set(device, node);
    node.dataset.testid = `step-${device}`;
    node.setAttribute("role", "button");
    node.tabIndex = -1;
    node.addEventListener("click", () => {
      chosen = chosen === device ? null : device;
      explain();
    });
    node.addEventListener("keydown", (event) => {
      if (event.key !== "Enter") return;
      event.preventDefault();
      node.dispatchEvent(new MouseEvent("click"));
    });
    set(node, "data-row", step.row);
    set(node, "data-col", step.col);
  }
  roving(drawing.svg, () => [...boxes.values()]);

  function explain() {
    const active = state.active ?? [];
    const device = chosen ?? active[0] ?? Object.keys(layout.steps)[0];
    if (!device) return;
    const step = layout.steps[device];
    const now = state[`${device}.now`];
    for (const [other, node] of boxes) set(node, "data-selected", other === chosen ? "" : null);
    write(who, step.name ? `${device} · ${step.name}` : device);
    const lines = [];
    if (now) lines.push(["active", `<b class="act">${seconds(now.elapsed_us, 2)} s</b> · ${number(now.scans)} ${now.scans === 1 ? "scan" : "scans"}`]);
    else lines.push(["active", "no"]);
    for (const [name, output, on] of now?.outputs ?? step.outputs.map(([name, output]) => [name, output, null]))
      lines.push(["output", `${named(name, output)}${on === null ? "" : on ? ' <b class="on">on</b>' : " off"}`]);
    for (const text of now?.waits ?? []) lines.push(["waits for", text.map(([name, device, words]) => (device ? `${named(name, device)} ${escaped(words)}` : escaped(words))).join(" ")]);
    const usual = state[`${device}.usual`];
    if (usual) lines.push(["usual", `${seconds(usual[0], 2)} s, ${number(usual[1])} ${usual[1] === 1 ? "time" : "times"}`]);
    if (step.then.length) lines.push(["then", step.then.map((one) => `<span class="mono">${escaped(one)}</span>`).join(" or ")]);
    const markup = lines.map(([word, text]) => `<dt>${word}</dt><dd>${text}</dd>`).join("");
    if (facts.dataset.markup !== markup) facts.innerHTML = facts.dataset.markup = markup;
  }

  return {
    apply(changes, now) {
      state = now;
      drawing.apply(changes);
      if (changes.active) {
        write(sub, `${changes.active.length} of ${Object.keys(layout.steps).length} active`);
        for (const [device, node] of boxes) {
          set(node, "data-on", changes.active.includes(device) ? "" : null);
          const words = `${device} ${layout.steps[device].name}`.trim();
          set(node, "aria-label", changes.active.includes(device) ? `${words}, active` : words);
        }
      }
      explain();
      if (changes.log)
        log.innerHTML = changes.log
          .map(([time_us, from, to, why]) => `<li><span>${seconds(time_us)}</span><span><span class="mono">${escaped(from ? `${from} → ${to}` : to)}</span><small>${escaped(why)}</small></span></li>`)
          .join("");
    },
  };
};
