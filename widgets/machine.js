// The machine's picture, moved by its plant; below it the sensors and the machine's own faults, to be switched in and out.

panels.machine = (place, layout, page, view) => {
  const { sensors = [], faults = [], times = [] } = layout;
  const tools = `<button class="tool" data-testid="all-well" title="switch out all faults" disabled>${icon("reset")}All well</button>`;
  const { section, body, sub } = frame(place, { title: layout.title, sub: "machine", key: "machine", tools });
  section.classList.add("mach");
  body.classList.add("scroll");
  const drawing = new Drawing(body, layout.svg);
  body.insertAdjacentHTML("beforeend", '<ul class="marks" aria-label="Faults of the machine"></ul>');
  const marks = body.lastElementChild;
  const well = section.querySelector("[data-testid=all-well]");
  let state = {};
  let run = {};
  let open = null; // the plate: its node, its sensor, the element that it stands at, what had the focus

  const list = (words, keys) => (keys.length ? `<div class="wrongs" role="group" aria-label="${words}"><span class="dim">${words}</span>${keys.join("")}</div>` : "");
  const cell = (row, col) => `data-row="${row}" data-col="${col}" tabindex="-1"`;
  section.insertAdjacentHTML(
    "beforeend",
    `<div class="ailments">${list(
      "Sensors",
      sensors.map(({ device, name, what }, at) => `<button class="sense" aria-haspopup="dialog" data-testid="sensor-${device}" data-sensor="${device}" title="${escaped(what)}" ${cell(0, at)}>${named(name, device)}<span class="wrong"></span></button>`),
    )}${list(
      "Faults",
      faults.map(({ name, what }, at) => `<button class="sense" role="switch" aria-checked="false" data-testid="fault-${escaped(name)}" data-fault="${escaped(name)}" title="${escaped(what)}" ${cell(1, at)}>${escaped(name)}</button>`),
    )}</div>`,
  );
  const keys = [...section.querySelectorAll(".ailments [data-row]")];
  const keyOf = (device) => keys.find((key) => key.dataset.sensor === device);
  roving(section.querySelector(".ailments"), () => keys);
  for (const key of keys) key.addEventListener("click", () => (key.dataset.sensor ? plate(key.dataset.sensor, key) : flip(key)));
  for (const { device } of sensors) {
    const tag = drawing.find(device);
    if (tag) set(tag, "data-sensed", "");
    tag?.addEventListener("click", () => plate(device, tag));
  }
  well.addEventListener("click", () => page.say("machine", "mend", { fault: "all" }));

  // -- keys in the drawing: a finger is on one until it is lifted, wherever that is

  const caps = [...drawing.svg.querySelectorAll("[data-key]")];
  let finger = null;
  const lift = () => {
    if (finger) page.say("machine", "release", { key: finger });
    finger = null;
  };
  const touch = (key) => {
    lift();
    if (page.dead) return;
    finger = key;
    page.say("machine", "press", { key });
  };
  if (caps.length) {
    set(drawing.svg, "role", "group"); // what is in a picture cannot be pressed
    roving(drawing.svg, () => caps);
  }
  for (const cap of caps) {
    set(cap, "role", "button");
    cap.addEventListener("pointerdown", () => touch(cap.dataset.key));
    cap.addEventListener("keydown", (event) => {
      if (![" ", "Enter"].includes(event.key)) return;
      event.preventDefault();
      event.stopPropagation();
      if (!event.repeat) touch(cap.dataset.key);
    });
    cap.addEventListener("keyup", (event) => [" ", "Enter"].includes(event.key) && lift());
    cap.addEventListener("blur", lift);
  }
  for (const end of ["pointerup", "pointercancel"]) document.addEventListener(end, lift);

  const flip = (key) => !page.dead && page.say("machine", key.getAttribute("aria-checked") === "true" ? "mend" : "fail", { fault: key.dataset.fault });

  // -- the plate of a sensor

  function plate(device, anchor) {
    const again = open?.device === device;
    close();
    if (again || page.dead) return;
    const { name, what } = sensors.find((each) => each.device === device);
    const contact = device[0] === "X";
    const wrong = state[`sensor.${device}`]?.wrong;
    const amount = (kind, usual) => (wrong?.kind === kind ? wrong.amount : usual);
    const act = (fault, words, name = fault.replaceAll(" ", "-")) => `<button class="btn" data-act="${fault}" data-testid="${name}">${words}</button>`;
    const timed = ({ kind, unit, usual }) =>
      `<p class="entry"><label>${kind} ${kind === "bounces" ? "for" : "by"} <input data-testid="${kind}-amount" data-amount="${kind}" value="${amount(kind, usual)}" size="6" inputmode="decimal" autocomplete="off" spellcheck="false"> ${unit}</label>${act(kind, kind === "bounces" ? "Bounce" : "Delay")}</p>`;
    const node = document.createElement("div");
    node.className = "plate-pop sensor-plate";
    node.dataset.testid = "sensor-plate";
    node.setAttribute("role", "dialog");
    node.setAttribute("aria-label", `${device} ${name}, sensor`.trim());
    node.innerHTML = `
      <p><b class="mono">${escaped(device)}</b> ${escaped(name)} <span class="dim">${escaped(what)}</span></p>
      <p class="rowline"><span>the sensor says</span><b data-testid="says"></b><span>at the terminal</span><b data-testid="comes"></b></p>
      <p class="refused" role="alert" hidden></p>
      <p class="acts2">${act("well", "As it is", "as-it-is")}<span class="split"></span>${contact ? act("stuck 0", "Stuck 0") + act("stuck 1", "Stuck 1") + act("inverted", "Inverted") : ""}</p>
      ${contact ? times.map(timed).join("") : `<p class="entry"><label>stuck at <input data-testid="stuck-amount" data-amount="stuck" value="${amount("stuck", 0)}" size="8" inputmode="decimal" autocomplete="off" spellcheck="false"></label>${act("stuck", "Stick")}</p>`}`;
    view.root.append(node);
    open = { node, device, anchor, back: document.activeElement };
    for (const button of node.querySelectorAll("[data-act]")) button.addEventListener("click", () => ask(button.dataset.act));
    node.addEventListener("keydown", (event) => {
      event.stopPropagation();
      if (event.key === "Escape") close(true);
      else if (event.key === "Enter" && event.target.dataset.amount) ask(event.target.dataset.amount);
      else return;
      event.preventDefault();
    });
    fill();
    placeBelow(view, node, anchor);
    node.querySelector("[aria-pressed=true], button").focus({ preventScroll: true });
  }

  function ask(fault) {
    const { device, node } = open;
    const field = node.querySelector(`[data-amount="${fault}"]`);
    const heard = (refusal) => {
      if (open?.node !== node) return;
      const refused = node.querySelector(".refused");
      refused.hidden = !refusal;
      write(refused, refusal ?? "");
      if (field) set(field, "aria-invalid", refusal ? "true" : null);
    };
    if (fault === "well") page.request("machine", "mend", { fault: device }, heard);
    else page.request("machine", "fail", { fault: `${device} ${fault}${field ? ` ${field.value.trim()}` : ""}` }, heard);
  }

  function fill() {
    const { says, comes, wrong } = state[`sensor.${open.device}`] ?? {};
    write(open.node.querySelector("[data-testid=says]"), String(says ?? ""));
    write(open.node.querySelector("[data-testid=comes]"), String(comes ?? ""));
    const now = !wrong ? "well" : wrong.kind === "stuck" && open.device[0] === "X" ? `stuck ${wrong.amount}` : wrong.kind;
    for (const button of open.node.querySelectorAll("[data-act]")) set(button, "aria-pressed", String(button.dataset.act === now));
  }

  function close(focus) {
    if (!open) return;
    open.node.remove();
    if (focus) open.back?.focus({ preventScroll: true });
    open = null;
  }
  const outside = (event) => open && !open.node.contains(event.target) && !open.anchor.contains(event.target) && close();
  document.addEventListener("pointerdown", outside);

  // -- what is wrong: in the list, and as a dashed ring round the sensor's tag

  function sick({ device, name }) {
    const words = state[`sensor.${device}`]?.wrong?.words ?? "";
    const key = keyOf(device);
    set(key, "data-wrong", words ? "" : null);
    set(key, "aria-label", `${device} ${name}, ${words || "as it is"}`);
    write(key.querySelector(".wrong"), words);
    const tag = drawing.find(device);
    const ring = tag?.querySelector(".ailing");
    if (ring && !words) ring.remove();
    else if (ring) write(ring.querySelector("text"), words);
    else if (words && tag?.querySelector("rect")) {
      const [x, y, width, height] = ["x", "y", "width", "height"].map((side) => Number(tag.querySelector("rect").getAttribute(side)));
      tag.insertAdjacentHTML(
        "beforeend",
        `<g class="ailing"><rect x="${x - 4}" y="${y - 4}" width="${width + 8}" height="${height + 8}" rx="${height / 2 + 4}"/><text x="${x + width / 2}" y="${y - 8}" text-anchor="middle">${escaped(words)}</text></g>`,
      );
    }
  }

  function tell() {
    const own = state.faults ?? [];
    for (const key of keys.filter((key) => key.dataset.fault)) {
      set(key, "aria-checked", String(own.includes(key.dataset.fault)));
      set(key, "data-wrong", own.includes(key.dataset.fault) ? "" : null);
    }
    const shown = own.map((name) => `<li>${escaped(name)}</li>`).join("");
    if (marks.dataset.shown !== shown) marks.innerHTML = marks.dataset.shown = shown;
    const count = own.length + sensors.filter(({ device }) => state[`sensor.${device}`]?.wrong).length;
    well.disabled = page.dead || !count;
    const told = count ? `, ${count} ${count === 1 ? "fault" : "faults"}` : "";
    write(sub, run.plant === false ? `machine, disconnected: the switches are yours${told}` : `machine${told}`);
  }

  return {
    apply(changes, now) {
      state = now;
      drawing.apply(changes);
      for (const sensor of sensors) if (changes[`sensor.${sensor.device}`]) sick(sensor);
      tell();
      if (open) fill();
    },
    run(now) {
      run = now;
      set(section, "data-off", run.plant === false ? "" : null);
      tell();
    },
    rest(dead) {
      if (dead) close();
      for (const key of keys) set(key, "aria-disabled", dead ? "true" : null);
      tell();
    },
    close() {
      document.removeEventListener("pointerdown", outside);
      for (const end of ["pointerup", "pointercancel"]) document.removeEventListener(end, lift);
      lift();
      close();
    },
  };
};
