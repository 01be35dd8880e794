// The plate of a device: what it holds on its way, and writing and forcing it. The unit, the ladder and the device table share it.
//
//   const plate = platesOf("unit", page, view);
//   plate.open(anchor, { device: "X6", name: "EStop", what: "emergency stop" });   `anchor` is the element that it stands below
//   plate.show(state);                                                             with every frame of the panel's state
//
// Python's side is a part of class Plated: the verbs look, leave, typed, write, force and unforce, the entry "plate.<id>".

// Below the anchor, or above it where the panel has no room below; never wider than the view.
function placeBelow(view, node, anchor) {
  const [spot, root] = [anchor.getBoundingClientRect(), view.root.getBoundingClientRect()];
  const zoom = root.width / view.root.offsetWidth || 1;
  const left = (spot.left + spot.width / 2 - root.left) / zoom - node.offsetWidth / 2;
  node.style.left = `${Math.max(4, Math.min(left, view.root.offsetWidth - node.offsetWidth - 4))}px`;
  const below = (spot.bottom - root.top) / zoom + 6;
  const above = (spot.top - root.top) / zoom - 6 - node.offsetHeight;
  node.style.top = `${below + node.offsetHeight > view.root.offsetHeight && above >= 0 ? above : below}px`;
}

let plateCount = 0;

function platesOf(part, page, view, { closed = () => {} } = {}) {
  const id = `${Math.random().toString(36).slice(2, 8)}${++plateCount}`;
  let node = null;
  let now = null; // what is shown
  let entry = null;
  let asked = 0; // the number of the last request
  let closing = 0; // the request after which the plate closes

  const say = (verb, values = {}) => page.say(part, verb, { plate: id, ...values });
  const ask = (verb, text, close = false) => {
    asked = Math.max(asked, entry?.done ?? 0) + 1;
    if (close) closing = asked;
    say(verb, text === undefined ? { n: asked } : { n: asked, text });
  };
  const field = () => node.querySelector("input");

  function open(anchor, { device, name = "", what = "", look = null, label = device }) {
    const again = now?.label === label;
    close();
    if (again || page.dead) return;
    node = document.createElement("div");
    node.className = "plate-pop";
    node.dataset.testid = "plate";
    node.setAttribute("role", "dialog");
    node.setAttribute("aria-label", `${device} ${name}`.trim());
    node.innerHTML = `
      <p><b class="mono">${escaped(device)}</b> ${escaped(name)} <span class="dim">${escaped(what)}</span></p>
      <div class="rest"></div>`;
    view.root.append(node);
    now = { device, label, anchor, back: document.activeElement, fresh: true };
    entry = null;
    node.addEventListener("keydown", keys);
    placeBelow(view, node, now.anchor);
    say("look", look ? { device, look } : { device });
  }

  function build() {
    const key = (act, words, more = "", shortcut = "") =>
      `<button class="btn ${more}" data-act="${act}" data-testid="${act}">${words}${shortcut ? ` <kbd>${shortcut}</kbd>` : ""}</button>`;
    node.querySelector(".rest").innerHTML = entry.bit
      ? `<p class="rowline"></p><p class="refused" role="alert" hidden></p>
         <p class="acts2">${key("off", "Off")}${key("on", "On")}<span class="split"></span>${key("force-off", "Force off")}${key("force-on", "Force on")}${key("release", "Release")}</p>`
      : `<p class="rowline"></p><p class="entry"><input data-testid="plate-value" aria-label="New value of ${escaped(entry.device)}" spellcheck="false" autocomplete="off" size="14"><span class="dim">${escaped(entry.look)}</span></p>
         <p class="equals mono"></p><p class="refused" role="alert" hidden></p>
         <p class="acts2">${key("write", "Write", "primary", "Enter")}${key("force", "Force", "force", "Shift Enter")}${key("release", "Release")}${key("leave", "Leave", "", "Esc")}</p>`;
    for (const button of node.querySelectorAll("[data-act]")) button.addEventListener("click", () => act(button.dataset.act));
    if (!entry.bit) {
      field().value = entry.text;
      field().addEventListener("input", () => say("typed", { text: field().value }));
    }
  }

  function act(name) {
    const bits = { off: ["write", "0"], on: ["write", "1"], "force-off": ["force", "0"], "force-on": ["force", "1"] };
    if (name === "leave") close(true);
    else if (name === "release") ask("unforce");
    else if (bits[name]) ask(...bits[name]);
    else ask(name, field().value, true);
  }

  function keys(event) {
    event.stopPropagation();
    if (event.key === "Escape") close(true);
    else if (event.key === "Enter" && event.target === field()) act(event.shiftKey ? "force" : "write");
    else return;
    event.preventDefault();
  }

  function show(state) {
    const next = node && state[`plate.${id}`];
    if (!next || next === entry) return;
    const first = !entry || entry.device !== next.device || entry.look !== next.look || entry.bit !== next.bit;
    if (first && now.fresh && next.device !== now.device.split(":")[0]) return; // the entry of the plate before
    entry = next;
    if (first) build();
    if (closing && entry.done >= closing) {
      closing = 0;
      if (!entry.refused) return close(true);
    }
    const lines = entry.rows.map(([words, value]) => `<span>${escaped(words)}</span><b${value.startsWith("F ") ? ' class="fv"' : ""}>${escaped(value)}</b>`).join("");
    const rowline = node.querySelector(".rowline");
    if (rowline.dataset.lines !== lines) rowline.innerHTML = rowline.dataset.lines = lines;
    const refused = node.querySelector(".refused");
    refused.hidden = !entry.refused;
    write(refused, entry.refused);
    if (!entry.bit) {
      const equals = entry.equals.map(([format, text]) => `<span>${escaped(text)}${format === "decimal" ? " decimal" : ""}</span>`).join("");
      const line = node.querySelector(".equals");
      if (line.dataset.shown !== equals) line.innerHTML = line.dataset.shown = equals;
      set(field(), "aria-invalid", entry.refused ? "true" : null);
    }
    const forced = entry.forced !== null;
    const release = node.querySelector('[data-act="release"]');
    if (!forced && document.activeElement === release) (field() ?? node.querySelector("button")).focus({ preventScroll: true });
    release.disabled = !forced;
    for (const button of node.querySelectorAll('[data-act^="force-"]')) {
      const here = forced && (button.dataset.act === "force-on") === (entry.forced === "1");
      button.classList.toggle("force", here);
      set(button, "aria-pressed", String(here));
    }
    if (first) {
      now.fresh = false;
      placeBelow(view, node, now.anchor);
      const start = field() ?? node.querySelector("button");
      start.focus({ preventScroll: true });
      field()?.select();
    }
  }

  function close(focus) {
    if (!node) return;
    say("leave");
    node.remove();
    if (focus) now.back?.focus({ preventScroll: true });
    [node, now, entry, closing] = [null, null, null, 0];
    closed();
  }
  const outside = (event) => node && !node.contains(event.target) && !now.anchor.contains(event.target) && close();
  document.addEventListener("pointerdown", outside);

  return {
    open,
    show,
    close,
    get label() {
      return now?.label ?? null;
    },
    end() {
      document.removeEventListener("pointerdown", outside);
      close();
    },
  };
}
