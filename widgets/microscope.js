// The scan microscope: a slider through one scan, the network with one lit instruction, and what the scan writes.

panels.microscope = (place, layout, page) => {
  const { section, body, sub } = frame(place, {
    title: "Scan microscope",
    key: "microscope",
    tools: `<button class="tool" data-verb="back" data-testid="micro-back" title="One instruction back (←)">${icon("back")}Back</button>
      <button class="tool" data-verb="on" data-testid="micro-on" title="One instruction on (→)">${icon("scan")}On</button>
      <button class="tool" data-verb="play" data-testid="micro-play" aria-pressed="false" title="Play (P)">${icon("run")}Play</button>
      <button class="tool" data-verb="next" data-testid="micro-next" title="Do one scan and look at it (N)">${icon("step")}Next scan</button>`,
  });
  section.classList.add("micro");
  body.innerHTML = `
    <div class="micro-bar">
      <ol class="phases">${["Input latch", "Program", "Housekeeping", "Output refresh"].map((word, at) => `<li data-phase="${["input", "program", "housekeeping", "output"][at]}">${word}</li>`).join("")}</ol>
      <input type="range" min="0" max="0" value="0" aria-label="Place in the scan" data-testid="micro-place">
      <p class="said" role="status" data-testid="micro-words"></p>
    </div>
    <div class="micro-grid">
      <div class="micro-net"><p class="where dim"></p><div class="scroll" data-testid="micro-net"></div></div>
      <div class="micro-side">
        <table class="grid points" data-testid="micro-points"><thead><tr><th>Output</th><th></th><th>Program</th><th>Terminal</th></tr></thead><tbody></tbody></table>
        <div class="scroll micro-writes"><table class="grid writes" data-testid="micro-writes"><thead><tr><th class="num">No.</th><th>Instruction</th><th>Writes</th><th class="num">from</th><th class="num">to</th></tr></thead><tbody></tbody></table></div>
      </div>
    </div>`;
  const find = (selector) => section.querySelector(selector);
  const [slider, words, net, where] = ["input[type=range]", ".said", ".micro-net .scroll", ".where"].map(find);
  const [points, writes, play] = [".points tbody", ".writes tbody", '[data-verb="play"]'].map(find);
  const say = (verb, values) => page.say("microscope", verb, values);
  const PACE_MS = 600;

  let drawing;
  let state = {};
  let timer;
  function playing(on) {
    clearInterval(timer);
    timer = on ? setInterval(() => (state.place < state.last ? say("move", { by: 1 }) : playing(false)), PACE_MS) : undefined;
    set(play, "aria-pressed", String(Boolean(timer)));
  }
  const verbs = {
    back: () => say("move", { by: -1 }),
    on: () => say("move", { by: 1 }),
    play: () => {
      if (!timer && state.place >= state.last) say("go", { place: 0 });
      playing(!timer);
    },
    next: () => say("next"),
  };
  for (const button of section.querySelectorAll("[data-verb]")) button.addEventListener("click", () => verbs[button.dataset.verb]());
  slider.addEventListener("input", () => {
    playing(false);
    say("go", { place: Number(slider.value) });
  });
  section.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
    const act = {
      ArrowLeft: verbs.back, ArrowRight: verbs.on, ArrowUp: () => say("write", { by: -1 }), ArrowDown: () => say("write", { by: 1 }),
      Home: () => say("go", { place: 0 }), End: () => say("go", { place: state.last }), p: verbs.play, P: verbs.play, n: verbs.next, N: verbs.next,
    }[event.key];
    if (!act) return;
    event.preventDefault();
    event.stopPropagation();
    if (act !== verbs.play) playing(false);
    act();
  });
  const lamp = (on, title) => `<span class="bit ${on ? "on" : ""}" title="${title}">${on}</span>`;

  const sizes = fitting("microscope", net, page);
  return {
    apply(changes, now) {
      state = now;
      if (changes.svg !== undefined) {
        drawing = changes.svg ? new Drawing(net, changes.svg).still() : undefined;
        if (!drawing) net.innerHTML = "";
        drawing?.apply(state);
      } else drawing?.apply(changes);
      for (const node of net.querySelectorAll(".here")) node.scrollIntoView({ block: "nearest", inline: "nearest", container: "nearest" });
      write(sub, state.n ? `${state.about} · ${state.phase === "program" ? `instruction ${number(state.place)} of ${number(state.n)}` : `${number(state.n)} instructions`}` : "");
      set(slider, "max", state.last);
      slider.value = state.place;
      set(slider, "aria-valuetext", state.words);
      write(words, state.words ?? "");
      write(where, state.network ?? "");
      for (const node of section.querySelectorAll(".phases li")) set(node, "aria-current", node.dataset.phase === state.phase ? "step" : null);
      if (changes.points) {
        points.innerHTML = changes.points
          .map(([device, name, image, terminal]) => `<tr data-device="${device}"><td class="mono dev">${device}</td><td class="nm">${escaped(name)}</td><td>${lamp(image, "what the program has written")}</td><td>${lamp(terminal, "what the terminal has")}</td></tr>`)
          .join("");
      }
      if (changes.writes) {
        writes.innerHTML = changes.writes
          .map(([at, instruction, device, name, old, fresh, is]) => `<tr data-is="${is}" data-device="${device}"><td class="num dim">${at}</td><td class="mono">${escaped(instruction)}</td><td>${named(name, device)}</td><td class="num dim">${old}</td><td class="num"><b>${fresh}</b></td></tr>`)
          .join("") || '<tr><td colspan="5" class="dim">The program changes nothing in this scan.</td></tr>';
        const lit = writes.querySelector('[data-is="here"]') ?? [...writes.querySelectorAll('[data-is="done"]')].pop();
        const box = find(".micro-writes");
        if (lit) box.scrollTop = Math.max(0, lit.offsetTop - box.clientHeight / 2);
      }
    },
    rest(dead) {
      if (dead) playing(false);
      sizes.rest(dead);
      for (const node of section.querySelectorAll("button, input")) node.disabled = dead;
    },
    close() {
      playing(false);
      sizes.close();
    },
  };
};
