// The trace: Python draws lanes in pieces; here the window is moved, cursors are placed, lanes are ordered and files are kept.

Object.assign(ICONS, {
  keep: '<path d="M8 2v8M5 7.25L8 10l3-2.75M3 9.5v4h10v-4"/>',
  rise: '<path d="M1.5 12.5h6v-9h7M10.5 7.5l-3-3-3 3"/>',
});

// A file that Python packed, kept where the browser keeps downloads.
async function keep({ name, packed }) {
  const octets = Uint8Array.from(atob(packed), (sign) => sign.charCodeAt(0));
  const content = await new Response(new Blob([octets]).stream().pipeThrough(new DecompressionStream("gzip"))).blob();
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

panels.trace = (place, layout, page) => {
  const { section, body, sub } = frame(place, {
    title: "Trace",
    key: "trace",
    tools: `<label class="trace-field" title="Hold the window when this comes true: X1 rises, M0 falls, D0 > 100 and X1">${icon("rise")}<span class="visually-hidden">Trigger</span>
        <input class="mono" size="16" placeholder="trigger: X1 rises" spellcheck="false" data-testid="trace-trigger"></label>
      <button class="tool" data-testid="trace-follow" aria-pressed="true" title="Go on with the present, or hold (H)">${icon("follow")}Follow</button>
      <button class="tool" data-testid="trace-all" title="Show everything (F)">Fit</button>
      ${["csv", "vcd", "png"].map((form) => `<button class="tool" data-form="${form}" data-testid="trace-${form}" title="Keep everything as a file">${form === "csv" ? icon("keep") : ""}${form.toUpperCase()}</button>`).join("")}`,
  });
  section.classList.add("trace-panel");
  body.className = "panel-body scroll";
  body.tabIndex = 0;
  body.setAttribute("role", "group");
  body.setAttribute("aria-label", "Lanes");
  section.insertAdjacentHTML(
    "beforeend",
    `<footer class="panel-foot"><label class="trace-field"><span class="visually-hidden">Add lanes</span><input class="mono" size="14" placeholder="add: X0 D0 S" spellcheck="false" data-testid="trace-add"></label>
      <span class="key"><svg width="20" height="18" viewBox="0 0 20 18" aria-hidden="true"><path class="bit-line" d="M0 15.5H20"/><path class="pin" d="M10 15V6"/><path class="pin-head" d="M5 1h10l-5 7z"/></svg>on for one scan</span>
      <span class="count"></span><span class="armed" role="status"></span><span class="gap"></span>
      <span class="hints"><kbd>A</kbd> <kbd>B</kbd> set a cursor&ensp;<kbd>←</kbd> <kbd>→</kbd> to the next edge&ensp;<kbd>+</kbd> <kbd>−</kbd> zoom</span></footer>
    <p class="refused" role="alert" data-testid="trace-refused" hidden></p>`,
  );
  const test = (name) => section.querySelector(`[data-testid="${name}"]`);
  const [trigger, adding, follow, refused] = ["trace-trigger", "trace-add", "trace-follow", "trace-refused"].map(test);
  const say = (verb, values) => page.say("trace", verb, values);

  let drawing;
  let state = {};
  let letter = "A"; // the cursor that the arrows move
  let pointed; // the moment under the pointer, in us
  const scale = () => {
    const [begin, span, left, plot] = state.window;
    return { begin, span, left, plot, perPx: span / plot };
  };
  const at = (event) => {
    const { begin, span, left, perPx } = scale();
    const x = event.clientX - drawing.svg.getBoundingClientRect().left - left;
    return Math.max(begin, Math.min(begin + span, begin + x * perPx));
  };
  const middle = () => state.window[0] + state.window[1] / 2;
  const inPlot = (event) => {
    const { left, plot } = scale();
    const x = event.clientX - drawing.svg.getBoundingClientRect().left;
    return x >= left && x <= left + plot;
  };

  // -- lanes: keys, and dragging a name to another place
  const laneOf = (node) => Number(node.closest(".lane")?.dataset.row ?? -1);
  function laneKey(event, lane) {
    if (event.key === "Delete" || event.key === "Backspace") say("remove", { lane });
    else if (event.altKey && event.key === "ArrowUp") say("move", { lane, to: lane - 1 });
    else if (event.altKey && event.key === "ArrowDown") say("move", { lane, to: lane + 1 });
    else if (event.key === "Enter" || event.key === " ") say("style", { lane });
    else return false;
    return true;
  }

  // -- keys of the whole panel
  body.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || !state.window) return;
    const lane = laneOf(event.target);
    if (lane >= 0 && laneKey(event, lane)) return stop(event);
    if (event.altKey) return;
    const { begin, span } = scale();
    const on = event.target.closest(".cursor");
    if (on) letter = on.classList.contains("cB") ? "B" : "A";
    const key = event.key.toLowerCase();
    if (key === "a" || key === "b") {
      letter = key.toUpperCase();
      say("cursor", { letter, at: pointed ?? middle() });
    } else if (event.key === "ArrowLeft" || event.key === "ArrowRight") {
      const forward = event.key === "ArrowRight";
      if (event.shiftKey) say("look", { begin: begin + (forward ? 1 : -1) * span / 8, span });
      else say("edge", { letter, forward, ...(lane >= 0 ? { lane } : {}) });
    } else if (event.key === "+" || event.key === "=") say("zoom", { factor: 0.5, at: pointed ?? middle() });
    else if (event.key === "-" || event.key === "−") say("zoom", { factor: 2, at: pointed ?? middle() });
    else if (key === "f") say("all");
    else if (key === "h") say("follow", { on: !state.following });
    else if (key === "t") state.trigger ? say("arm", { text: state.trigger }) : trigger.focus();
    else if (event.key === "Escape") for (const each of "AB") say("cursor", { letter: each, at: null });
    else return;
    stop(event);
  });
  const stop = (event) => {
    event.preventDefault();
    event.stopImmediatePropagation();
  };
  roving(body, () => [...body.querySelectorAll(".lane")]); // up and down; left and right are the cursor's

  // -- mouse, pen and touch: a cursor or a name is dragged, the plane is pulled along, two fingers zoom, a click places a cursor
  const fingers = new Map();
  let hand;
  let due;
  function soon(act) {
    due ??= requestAnimationFrame(() => ((due = undefined), soon.act()));
    soon.act = act;
  }
  body.addEventListener("pointerdown", (event) => {
    if (event.button || !drawing || !event.target.closest("svg.trace")) return;
    fingers.set(event.pointerId, event.clientX);
    const cursor = event.target.closest(".cursor");
    const lane = laneOf(event.target);
    if (cursor) hand = { cursor: cursor.classList.contains("cB") ? "B" : "A" };
    else if (lane >= 0) hand = { lane, y: event.clientY };
    else if (inPlot(event)) hand = { x: event.clientX, ...scale(), moved: false };
    else return;
    if (fingers.size === 2) {
      const [one, two] = [...fingers.values()];
      hand = { ...scale(), apart: Math.abs(one - two), x: (one + two) / 2, at: at({ clientX: (one + two) / 2 }), moved: true };
    }
    body.setPointerCapture(event.pointerId);
    if (!event.target.closest(".lane")) body.focus({ preventScroll: true });
  });
  body.addEventListener("pointermove", (event) => {
    if (drawing && state.window) pointed = inPlot(event) ? at(event) : undefined;
    if (!hand) return;
    if (fingers.has(event.pointerId)) fingers.set(event.pointerId, event.clientX);
    if (hand.cursor) {
      letter = hand.cursor;
      const moment = at(event);
      soon(() => say("cursor", { letter: hand?.cursor ?? letter, at: moment }));
    } else if (hand.lane !== undefined) {
      hand.to = [...body.querySelectorAll(".lane")].findIndex((node) => node.getBoundingClientRect().bottom > event.clientY);
    } else if (hand.apart && fingers.size === 2) {
      const [one, two] = [...fingers.values()];
      const span = (hand.span * hand.apart) / Math.max(20, Math.abs(one - two));
      const share = (hand.at - hand.begin) / hand.span;
      soon(() => say("look", { begin: Math.max(0, hand.at - share * span), span }));
    } else if (Math.abs(event.clientX - hand.x) > 3 || hand.moved) {
      hand.moved = true;
      const { begin, span, perPx, x } = hand;
      soon(() => say("look", { begin: Math.max(0, begin - (event.clientX - x) * perPx), span }));
    }
  });
  const release = (event) => {
    fingers.delete(event.pointerId);
    if (!hand) return;
    const { lane, to, cursor, moved } = hand;
    if (lane !== undefined && Math.abs(event.clientY - hand.y) > 6) say("move", { lane, to: to < 0 || to === undefined ? 99 : to });
    else if (lane !== undefined && event.type === "pointerup") body.querySelector(`.lane[data-row="${lane}"]`)?.focus();
    else if (!cursor && !moved && event.type === "pointerup") {
      letter = event.shiftKey ? "B" : "A";
      say("cursor", { letter, at: at(event) });
    }
    if (!fingers.size) hand = undefined;
  };
  body.addEventListener("pointerup", release);
  body.addEventListener("pointercancel", release);
  body.addEventListener("dblclick", (event) => laneOf(event.target) >= 0 && say("style", { lane: laneOf(event.target) }));
  // The wheel zooms once the panel has the focus, or with Ctrl; before that it scrolls the page.
  body.addEventListener(
    "wheel",
    (event) => {
      if (!state.window || !inPlot(event) || !(event.ctrlKey || section.contains(document.activeElement))) return;
      event.preventDefault();
      const { begin, span, perPx } = scale();
      const across = event.shiftKey ? event.deltaY : event.deltaX;
      wheeled.by += event.deltaY;
      if (Math.abs(across) > Math.abs(event.shiftKey ? 0 : event.deltaY)) {
        wheeled.by = 0;
        soon(() => say("look", { begin: Math.max(0, begin + across * perPx), span }));
      } else {
        const moment = at(event);
        soon(() => {
          say("zoom", { factor: 2 ** (wheeled.by / 400), at: moment });
          wheeled.by = 0;
        });
      }
    },
    { passive: false },
  );
  const wheeled = { by: 0 };

  // -- tools
  follow.addEventListener("click", () => say("follow", { on: !state.following }));
  test("trace-all").addEventListener("click", () => say("all"));
  for (const button of section.querySelectorAll("[data-form]")) {
    button.addEventListener("click", () => page.request("trace", "export", { form: button.dataset.form }, (file) => file && keep(file)));
  }
  trigger.addEventListener("keydown", (event) => {
    if (event.key === "Enter") say("arm", { text: trigger.value });
    if (event.key === "Escape") trigger.value = state.trigger ?? "";
  });
  adding.addEventListener("keydown", (event) => {
    if (event.key !== "Enter" || !adding.value.trim()) return;
    adding.dataset.asked = "";
    say("add", { names: adding.value });
  });

  const sizes = fitting("trace", body, page);
  return {
    apply(changes, now) {
      state = now;
      if (changes.svg) {
        const focused = body.contains(document.activeElement) ? laneOf(document.activeElement) : -1;
        drawing = new Drawing(body, changes.svg);
        drawing.apply(state);
        const lanes = [...body.querySelectorAll(".lane")];
        if (lanes.length) lanes[Math.max(0, Math.min(focused, lanes.length - 1))].tabIndex = 0;
        if (focused >= 0) (lanes[Math.min(focused, lanes.length - 1)] ?? body).focus();
      } else drawing?.apply(changes);
      for (const [other, key] of [["A", "cA"], ["B", "cB"]]) {
        const node = drawing?.find(key);
        if (node) set(node, "aria-label", `Cursor ${other}`);
      }
      write(sub, `${state.about} · ${state.following ? "follows" : "held"}`);
      write(section.querySelector(".count"), state.foot ?? "");
      set(follow, "aria-pressed", String(Boolean(state.following)));
      write(section.querySelector(".armed"), state.armed ? "waits for the trigger" : state.hit ? `trigger at ${state.hit}` : "");
      if (changes.trigger !== undefined && document.activeElement !== trigger) trigger.value = state.trigger;
      if (changes.svg && "asked" in adding.dataset && !state.said) adding.value = "";
      if (changes.svg) delete adding.dataset.asked;
      write(refused, state.said ?? "");
      refused.hidden = !state.said;
    },
    rest(dead) {
      sizes.rest(dead);
      for (const node of section.querySelectorAll("button, input")) node.disabled = dead;
    },
    close: sizes.close,
  };
};
