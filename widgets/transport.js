// Run control: back, run or pause, one scan, next step; the clock; the speed; what the run does, in words.

const SPEEDS = [["¼", 0.25], ["½", 0.5], ["1", 1], ["2", 2], ["5", 5], ["10", 10], ["100", 100], ["max", null]];
const OCTAGON = '<svg class="ico" width="14" height="14" viewBox="0 0 16 16" aria-hidden="true"><path class="fill" d="M5.3 1.5h5.4l3.8 3.8v5.4l-3.8 3.8H5.3L1.5 10.7V5.3z"/></svg>';
const EVENT = { step: "s", breakpoint: "b", fault: "f" };
const DETENT = (at) => 12 + (180 / (SPEEDS.length - 1)) * at;

panels.transport = (place, layout, page) => {
  const key = (verb, word, shortcut, glyph, main = "") =>
    `<button class="keycap ${main}" data-verb="${verb}" data-testid="${verb === "toggle" ? "run" : verb.replace("_", "-")}"
      aria-keyshortcuts="${shortcut}" title="${word} (${shortcut})">${icon(glyph, 18)}<span>${word}</span></button>`;
  place.innerHTML = `
    <section class="transport" aria-label="Run control" data-testid="transport">
      <div class="tgrid">
        <div class="keys" role="group" aria-label="Run control">
          ${key("back", "Back", "ArrowLeft", "back")}${key("toggle", "Run", "R", "run", "main")}${key("scan", "One scan", "Space", "scan")}${key("next_step", "Next step", "N", "step")}
        </div>
        <div class="clock"><span class="label">simulated time<span class="past"></span></span><span class="big" data-testid="clock"><span class="whole">0</span><small>.000</small><i>s</i></span></div>
        <div class="stats">
          <div class="stat"><span class="label">scan</span><span class="value" data-testid="scans">0</span></div>
          <div class="stat"><span class="label">scan time</span><span class="value wide"><span class="ms">0.0</span><i>ms</i></span></div>
          <div class="stat sparkstat"><span class="label">watchdog ${number(layout.watchdog_ms)} ms</span>
            <svg class="spark" width="88" height="16" viewBox="0 0 88 16" aria-hidden="true"><path class="limit" d="M0 1.5H88"/><path class="bars" d=""/></svg></div>
        </div>
        <div class="stat speedstat"><span class="label">speed</span>
          <div class="speedbar" role="slider" tabindex="0" aria-label="Speed" aria-valuemin="0" aria-valuemax="${SPEEDS.length - 1}" data-testid="speed">
            <svg class="speed" width="204" height="36" viewBox="0 0 204 36" aria-hidden="true">
              <path class="track" d="M12 9H192"/><path class="track-on" d=""/>
              ${SPEEDS.map(([word], at) => `<path class="detent" d="M${DETENT(at)} 5.5v7"/><text x="${DETENT(at)}" y="31" text-anchor="middle">${word}</text>`).join("")}
              <rect class="thumb" y="1" width="9" height="16" rx="2"/></svg></div></div>
        <span class="chip" role="status" data-testid="chip"><span class="glyph"></span><span class="cut"></span></span>
        <button class="breaks" data-testid="breaks" aria-expanded="false" aria-haspopup="true" title="Breakpoints">${OCTAGON}<span>0</span></button>
        <div class="history">
          <span class="end from">0</span>
          <div class="line" role="slider" tabindex="0" aria-label="Position in the recorded run" data-testid="history"><b></b><span class="events"></span><u></u></div>
          <span class="end to">now</span>
        </div>
        <div class="points" data-testid="points" hidden>
          <form><input data-testid="break-text" placeholder="S21, D0 &gt; 100 and X1" aria-label="Stop when" spellcheck="false" autocomplete="off"><button class="btn" data-testid="break-add">Break</button></form>
          <p class="problem" role="alert" data-testid="break-problem" hidden></p>
          <ul></ul>
        </div>
        <div class="below">
          <button class="tool" data-verb="reset" data-testid="reset" title="Power off and on: time, memory and machine start anew">${icon("reset")}Reset</button>
          <button class="toggle" role="switch" data-testid="plant" aria-checked="false"><svg class="tog" width="28" height="16" viewBox="0 0 28 16" aria-hidden="true"><rect class="groove" x=".75" y=".75" width="26.5" height="14.5" rx="7.25"/><circle class="dot" cx="8" cy="8" r="4.5"/></svg><span>Machine connected</span></button>
          <span class="gap"></span>
          <span class="hints"><kbd>R</kbd> run or pause&ensp;<kbd>Space</kbd> one scan&ensp;<kbd>N</kbd> next step&ensp;<kbd>←</kbd> back</span>
        </div>
      </div>
    </section>`;
  const find = (selector) => place.querySelector(selector);
  const [section, chip, slider, plant] = [".transport", ".chip", ".speedbar", ".toggle"].map(find);
  const speeds = place.querySelectorAll(".speed text");
  const keycaps = [...place.querySelectorAll(".keycap")];

  let run = {};
  const press = (verb) => {
    const cap = find(`[data-verb="${verb}"]`);
    if (!cap.disabled) page.say("transport", verb === "toggle" ? (run.state === "running" ? "pause" : "run") : verb);
  };
  for (const cap of place.querySelectorAll("[data-verb]")) cap.addEventListener("click", () => press(cap.dataset.verb));
  // Space is one scan also on these keys; Enter presses the one that has the focus.
  find(".keys").addEventListener("keyup", (event) => event.key === " " && event.preventDefault());
  plant.addEventListener("click", () => page.say("transport", "plant", { on: plant.getAttribute("aria-checked") !== "true" }));
  if (!layout.plant) plant.hidden = true;

  const speedTo = (at) => page.say("transport", "speed", { value: SPEEDS[Math.max(0, Math.min(SPEEDS.length - 1, at))][1] });
  const detent = () => {
    const at = SPEEDS.findIndex(([, value]) => value === (run.speed ?? null));
    return at >= 0 ? at : SPEEDS.findIndex(([, value]) => value === null || value > run.speed) - 0.5;
  };
  slider.addEventListener("keydown", (event) => {
    const at = detent();
    const to = { ArrowLeft: Math.ceil(at) - 1, ArrowDown: Math.ceil(at) - 1, ArrowRight: Math.floor(at) + 1, ArrowUp: Math.floor(at) + 1, Home: 0, End: SPEEDS.length - 1 }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    speedTo(to);
  });
  let asked;
  const drag = (event) => {
    const box = slider.firstElementChild.getBoundingClientRect();
    const at = Math.round((((event.clientX - box.left) * 204) / box.width - 12) / (180 / (SPEEDS.length - 1)));
    if (at !== asked) speedTo((asked = at));
  };
  slider.addEventListener("pointerdown", (event) => {
    slider.setPointerCapture(event.pointerId);
    asked = undefined;
    drag(event);
  });
  slider.addEventListener("pointermove", (event) => slider.hasPointerCapture(event.pointerId) && drag(event));

  // -- the past: the handle stands where the page stands; dragged, the page shows that moment.
  const line = find(".history .line");
  const [marks, done, handle] = [".events", "b", "u"].map((part) => line.querySelector(part));
  let state = {};
  const last = () => (run.scan ?? 0) + (run.back ?? 0);
  const share = (scan) => (last() > state.first ? Math.max(0, Math.min(1, (scan - state.first) / (last() - state.first))) : 1);
  const percent = (scan) => `${(100 * share(scan)).toFixed(1)}%`; // about a pixel
  let wanted, asking;
  function seek(scan) {
    const to = Math.max(state.first ?? 0, Math.min(last(), Math.round(scan)));
    if (to === wanted || page.dead) return;
    wanted = to;
    asking ??= requestAnimationFrame(() => {
      asking = undefined;
      page.say("transport", "seek", { scan: wanted });
    });
  }
  const drop = (event) => {
    const box = line.getBoundingClientRect();
    seek(state.first + ((event.clientX - box.left) / box.width) * (end - state.first));
  };
  let end = 0; // the newest scan when the drag began: the bar does not grow under the hand
  line.addEventListener("pointerdown", (event) => {
    if (page.dead || run.state === "failed") return;
    line.setPointerCapture(event.pointerId);
    wanted = undefined;
    end = last();
    drop(event);
  });
  line.addEventListener("pointermove", (event) => line.hasPointerCapture(event.pointerId) && drop(event));
  line.addEventListener("keydown", (event) => {
    const scan = run.scan ?? 0;
    const steps = (state.events ?? []).map(([at]) => at);
    const to = {
      ArrowLeft: scan - 1, ArrowDown: scan - 1, ArrowRight: scan + 1, ArrowUp: scan + 1, Home: state.first, End: last(),
      PageUp: steps.filter((at) => at < scan).pop() ?? state.first, PageDown: steps.find((at) => at > scan) ?? last(),
    }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    wanted = undefined;
    seek(to);
  });
  function past() {
    if (state.first === undefined) return;
    const period = (run.scan_us ?? 0) || 1;
    done.style.width = handle.style.left = percent(run.scan);
    write(find(".history .from"), seconds(Math.max(0, (run.time_us ?? 0) - (run.scan - state.first) * period)));
    write(find(".history .to"), run.back || page.dead ? seconds((run.time_us ?? 0) + (run.back_us ?? 0)) : "now");
    write(find(".clock .past"), run.back ? `−${run.back_us < 1e6 ? `${number(run.back_us / 1000)} ms` : `${seconds(run.back_us, 2)} s`}` : "");
    set(line, "aria-valuemin", state.first);
    set(line, "aria-valuemax", last());
    set(line, "aria-valuenow", run.scan);
    set(line, "aria-valuetext", `${seconds(run.time_us ?? 0)} s, ${run.back ? `${number(run.back)} scans back` : "now"}`);
    set(line, "aria-disabled", page.dead ? "true" : null);
    // While the run goes on all marks move a little with every update: twice a second is enough for them.
    const late = run.state !== "running" || performance.now() - placed > 500;
    if (late) placed = performance.now();
    for (const one of shown) {
      const at = late || one.at === undefined ? percent(one.scan) : one.at;
      if (one.at !== at) one.node.style.left = one.at = at;
    }
  }
  let placed = 0;
  // Events come at the end and go at the beginning; the marks of those between stay.
  let shown = [];
  function events() {
    const before = new Map(shown.map((one) => [one.key, one]));
    shown = (state.events ?? []).map(([scan, kind, words]) => {
      const key = `${kind} ${scan} ${words}`;
      const known = before.get(key);
      if (known && before.delete(key)) return known;
      const node = Object.assign(document.createElement("i"), { className: `ev ${EVENT[kind]}`, title: `${words}, scan ${number(scan)}` });
      marks.append(node);
      return { key, scan, node };
    });
    for (const { node } of before.values()) node.remove();
  }

  // -- breakpoints: a list under its button; what cannot be read is refused there and the field keeps it.
  const [button, points, form, problem] = [".breaks", ".points", ".points form", ".problem"].map(find);
  const field = form.querySelector("input");
  const unfold = (open) => {
    points.hidden = !open;
    set(button, "aria-expanded", String(open));
    (open ? field : button).focus();
  };
  button.addEventListener("click", () => unfold(points.hidden));
  points.addEventListener("keydown", (event) => {
    if (event.key === "Escape") unfold(false);
    event.stopPropagation();
  });
  let written = "";
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    written = field.value.trim().replace(/\s+/g, " ");
    if (written) page.say("transport", "break_add", { text: written });
  });
  points.querySelector("ul").addEventListener("click", (event) => {
    const text = event.target.closest("li")?.dataset.text;
    const verb = event.target.closest("button")?.dataset.act;
    if (verb === "remove") page.say("transport", "break_remove", { text });
    if (verb === "enable") page.say("transport", "break_enable", { text, on: event.target.closest("button").getAttribute("aria-checked") !== "true" });
  });
  function breaks() {
    const list = state.breaks ?? [];
    write(button.querySelector("span"), String(list.length));
    set(button, "aria-label", `${list.length} ${list.length === 1 ? "breakpoint" : "breakpoints"}`);
    points.querySelector("ul").innerHTML = list
      .map(
        ([text, on, hits, why], at) => `<li data-text="${escaped(text)}" class="${on && !why ? "" : "off"}">
          <button role="switch" aria-checked="${Boolean(on)}" data-act="enable" data-testid="break-${at}" aria-label="${escaped(text)}" title="${on ? "Switch off" : "Switch on"}">${OCTAGON}</button>
          <span class="mono">${escaped(text)}</span><span class="dim">${why ? escaped(why) : `${on ? "" : "off, "}${number(hits)} ${hits === 1 ? "stop" : "stops"}`}</span>
          <button class="tool" data-act="remove" data-testid="break-${at}-remove" aria-label="Remove ${escaped(text)}" title="Remove">${icon("cross", 12)}</button></li>`,
      )
      .join("");
    if (written && list.some(([text]) => text === written)) {
      if (field.value.trim().replace(/\s+/g, " ") === written) field.value = "";
      written = "";
    }
    problem.hidden = !state.problem;
    write(problem, state.problem ?? "");
  }

  function say() {
    const words = {
      running: ["run", "", run.mode === "RUN" ? "Running" : "Running, PLC in STOP"],
      paused: ["pause", "", "Paused"],
      stopped: ["stop", "", "Stopped"],
      failed: ["cross", "fault", run.error],
    };
    let [glyph, kind, text] = words[run.state] ?? words.stopped;
    if (run.back) [glyph, kind, text] = ["back", "past", `${number(run.back)} ${run.back === 1 ? "scan" : "scans"} back`];
    if (run.hit) [glyph, kind, text] = ["brk", "brk", `Stopped: ${run.hit}${/^S\d+$/.test(run.hit) ? " began" : ""}`];
    if (run.held && kind === "") text += ", transitions held";
    if (run.fault && run.state !== "failed") [glyph, kind, text] = ["cross", "fault", run.fault];
    if (run.refused) [glyph, kind, text] = ["cross", "fault", run.refused];
    if (page.dead) [glyph, kind, text] = ["unplugged", "dead", "Not connected: the last state"];
    set(chip, "class", `chip ${kind}`);
    set(chip, "role", kind === "fault" ? "alert" : "status");
    set(chip, "title", text);
    const mark = chip.querySelector(".glyph");
    if (mark.dataset.glyph !== glyph) {
      mark.dataset.glyph = glyph;
      mark.innerHTML = icon(glyph, 14);
    }
    write(chip.querySelector(".cut"), text ?? "");
    set(section, "class", `transport ${kind}`);
    set(section, "data-state", run.state);
  }

  function keys() {
    const running = run.state === "running";
    const over = page.dead || run.state === "failed";
    const main = find('[data-verb="toggle"]');
    if (main.dataset.shows !== String(running)) {
      main.dataset.shows = String(running);
      main.classList.toggle("lit", running);
      main.innerHTML = `${icon(running ? "pause" : "run", 18)}<span>${running ? "Pause" : "Run"}</span>`;
      set(main, "title", `${running ? "Pause" : "Run"} (R)`);
    }
    for (const cap of keycaps) cap.disabled = over || (cap !== main && running);
    find('[data-verb="back"]').disabled ||= run.can_back === false;
    find('[data-verb="reset"]').disabled = page.dead;
    for (const node of [plant, slider]) set(node, "aria-disabled", over ? "true" : null);
  }

  return {
    press,
    apply(changes, now) {
      state = now;
      if (changes.events) events();
      if (changes.breaks || "problem" in changes) breaks();
      past();
    },
    run(now) {
      run = now;
      const [whole, part] = seconds(run.time_us ?? 0).split(".");
      write(find(".whole"), whole);
      write(find(".clock small"), `.${part}`);
      write(find('[data-testid="scans"]'), number(run.scan ?? 0));
      write(find(".ms"), number((run.scan_us ?? 0) / 1000, 1));
      const bar = (us) => Math.min(12, Math.max(1, (12 * Math.log1p(us / 1000)) / Math.log1p(layout.watchdog_ms || 200)));
      const bars = (run.recent ?? []).map((us, at) => `M${2 + 3.5 * at} 14v-${bar(us).toFixed(1)}`).join("");
      set(find(".spark .bars"), "d", bars);
      const at = detent();
      set(find(".track-on"), "d", `M12 9H${DETENT(at)}`);
      set(find(".thumb"), "x", DETENT(at) - 4.5);
      speeds.forEach((text, index) => set(text, "class", index === at ? "here" : null));
      set(slider, "aria-valuenow", at);
      set(slider, "aria-valuetext", run.speed == null ? "as fast as possible" : `${run.speed} times real time`);
      set(plant, "aria-checked", String(Boolean(run.plant)));
      past();
      say();
      keys();
    },
    rest() {
      past();
      say();
      keys();
    },
  };
};
