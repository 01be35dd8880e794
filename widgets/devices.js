// The device table: rows that exist only while they are in sight. The page tells Python which rows those are, and gets those alone.

const ROW_PX = 30;
const SPARE = 12; // rows kept ready above and below what is in sight
const SHOWN = 14; // rows in sight
const FIELDS = [["device", "Device"], ["name", "Name"], ["value", "Value"]];

// Bits as boxes in fours: ones tall and solid, changed ones heavier. 32 bits stand in two lines, the high ones above.
function bitPaths(bits, width, changed) {
  const found = { zero: "", one: "", fresh: "" };
  const lines = width > 16 ? 2 : 1;
  const perLine = width / lines;
  for (let at = 0; at < width; at++) {
    const bit = width - 1 - at;
    const [line, column] = [Math.floor(at / perLine), at % perLine];
    const x = column * 9 + Math.floor(column / 4) * 5 + 0.5;
    const one = Math.floor(bits / 2 ** bit) % 2;
    const [tall, top] = lines === 1 ? (one ? [13, 2.5] : [7, 5.5]) : one ? [9, 0.5 + 11 * line] : [4, 3.5 + 11 * line];
    const box = `M${x} ${top}h7v${tall}h-7z`;
    found[one ? "one" : "zero"] += box;
    if (Math.floor(changed / 2 ** bit) % 2) found.fresh += box;
  }
  return found;
}
const differing = (a, b) => ((Math.floor(a / 65536) ^ Math.floor(b / 65536)) >>> 0) * 65536 + (((a % 65536) ^ (b % 65536)) >>> 0);

panels.devices = (place, layout, page, view) => {
  const id = Math.random().toString(36).slice(2, 10);
  const { menus = {} } = layout;
  const lens = '<svg class="ico" width="14" height="14" viewBox="0 0 16 16" aria-hidden="true"><circle cx="7" cy="7" r="4.25"/><path d="M10.25 10.25L14 14"/></svg>';
  const plus = '<svg class="ico" width="14" height="14" viewBox="0 0 16 16" aria-hidden="true"><path d="M8 3v10M3 8h10"/></svg>';
  const lock = '<svg class="ico" width="14" height="14" viewBox="0 0 16 16" aria-hidden="true"><rect x="3.5" y="7.25" width="9" height="6"/><path d="M5.5 7V5a2.5 2.5 0 0 1 5 0v2"/></svg>';
  const { body, section, sub } = frame(place, { title: "Devices", key: "devices" });
  section.classList.add("with-menu");
  body.innerHTML = `
    <div class="addbar">
      <div class="field">${plus}<input data-testid="add" role="combobox" aria-label="Add devices" aria-expanded="false" aria-autocomplete="list" aria-controls="offers-${id}" placeholder="name, device or range, D0-D99" spellcheck="false" autocomplete="off"><ul class="menu" role="listbox" id="offers-${id}" data-testid="offers" hidden></ul></div>
      <span class="refused" role="alert" data-testid="refused" hidden></span><span class="gap"></span>
      <div class="field find">${lens}<input data-testid="find" aria-label="Find in the table" placeholder="find" spellcheck="false" autocomplete="off"></div>
      <button class="tool" data-only="changed" data-testid="changed-only" aria-pressed="false" title="Rows whose value has changed since this was pressed">Changed</button>
      <button class="tool" data-only="forced" data-testid="forced-only" aria-pressed="false" title="Forced rows alone">Forced</button>
      <button class="tool" data-testid="release-all" title="End all forcing">${lock}Release all</button>
      <button class="tool" data-testid="clear">Clear</button>
    </div>
    <div class="devices" role="grid" aria-label="Devices" tabindex="0" data-testid="grid">
      <div class="heads" role="row"><span role="columnheader"><span class="visually-hidden">Forced</span></span>${FIELDS.map(
        ([key, words]) => `<span role="columnheader" class="${key}"><button data-sort="${key}" data-testid="sort-${key}">${words}<i></i></button></span>`,
      ).join("")}<span role="columnheader" class="was">Before</span><span role="columnheader" class="bitcol">Bits</span><span role="columnheader">Format</span><span role="columnheader" class="what">Comment</span></div>
      <div class="rows scroll" data-testid="rows"><div class="tall" role="presentation"></div></div>
      <p class="nothing" hidden></p>
    </div>
    <footer class="panel-foot"><span class="tally"></span><span class="gap"></span><span><kbd>F2</kbd> edit <kbd>F</kbd> format <kbd>Enter</kbd> write <kbd>Shift Enter</kbd> force <kbd>Del</kbd> release or remove</span></footer>`;
  const find = (selector) => body.querySelector(selector);
  const [grid, rows, tall, adder, offers, finder] = [".devices", ".rows", ".tall", "[data-testid=add]", ".menu", "[data-testid=find]"].map(find);
  const plate = platesOf("devices", page, view, { closed: () => (here >= 0 ? mark() : null) });

  let state = {};
  let shown = [0, [], 0];
  const known = new Map(); // row -> its text before, and what changed when
  let here = -1; // the row that the keyboard is at
  let asked = null; // the window that Python was asked for
  let request = 0;
  let lastAdd = 0;
  let picked = -1; // the offer that the arrows are at
  let arranged = ["", "", false, ""];
  const slots = [];
  let [top, high] = [0, 0]; // from where and how much of the rows is in sight, in px

  const say = (verb, values) => page.say("devices", verb, values);
  const numberAt = (index) => shown[1][index - shown[0]];

  // -- rows -----------------------------------------------------------------------------------------------------

  const slotFor = (index) => slots[index % slots.length];
  function makeSlots() {
    const count = Math.ceil((high || SHOWN * ROW_PX) / ROW_PX) + 1 + 2 * SPARE;
    if (slots.length >= count) return;
    for (const slot of slots) slot.index = -1;
    while (slots.length < count) {
      const node = document.createElement("div");
      node.className = "row";
      node.setAttribute("role", "row");
      node.innerHTML = `
        <span role="gridcell" class="fcol"></span><span role="gridcell" class="device"><span class="tag"></span></span><span role="gridcell" class="name"></span>
        <span role="gridcell" class="value"><b></b></span><span role="gridcell" class="was"></span>
        <span role="gridcell" class="bitcol"><svg class="bits" width="159" height="20" viewBox="0 0 159 20" aria-hidden="true"><path class="zero"/><path class="one"/><path class="fresh"/></svg></span>
        <span role="gridcell" class="fmt"><select tabindex="-1" aria-label="Format"></select></span><span role="gridcell" class="what"></span>`;
      const slot = { node, index: -1, number: null, shape: "" };
      for (const name of ["fcol", "tag", "name", "was", "what"]) slot[name] = node.querySelector(`.${name}`);
      [slot.value, slot.text, slot.bits, slot.select] = [".value", ".value b", ".bits", "select"].map((selector) => node.querySelector(selector));
      [slot.zero, slot.one, slot.fresh] = slot.bits.children;
      slot.select.addEventListener("change", () => say("show", { view: id, n: ++request, number: slot.number, look: slot.select.value }));
      node.addEventListener("pointerdown", (event) => !event.target.closest("select") && choose(slot.index));
      node.addEventListener("dblclick", (event) => !event.target.closest("select") && edit());
      tall.append(node);
      slots.push(slot);
    }
  }

  function fill(slot) {
    const number_ = numberAt(slot.index);
    const of = state[`row.${number_}.of`];
    const value = state[`row.${number_}`];
    slot.number = of && value ? number_ : null;
    slot.node.hidden = slot.index < 0 || slot.index >= shown[2];
    set(slot.node, "aria-rowindex", slot.index + 2);
    set(slot.node, "data-here", slot.index === here ? "" : null);
    set(slot.node, "aria-selected", String(slot.index === here));
    if (slot.number === null) {
      if (slot.shape !== "empty") {
        slot.shape = "empty";
        for (const name of ["tag", "name", "was", "what", "text"]) write(slot[name], "");
        set(slot.node, "data-testid", null);
        set(slot.node, "data-waits", "");
        set(slot.node, "data-forced", null);
        set(slot.node, "data-changed", null);
      }
      return;
    }
    const [device, name, what, look, menu, width, label] = of;
    const shape = `${device} ${name} ${what} ${look} ${menu} ${label}`;
    if (slot.shape !== shape) {
      slot.shape = shape;
      set(slot.node, "data-waits", null);
      set(slot.node, "data-testid", `device-${label}`);
      slot.node.id = `row-${id}-${number_}`;
      write(slot.tag, device);
      set(slot.tag, "class", /^X\d/.test(device) ? "tag in" : /^Y\d/.test(device) ? "tag out" : "tag plain mono");
      write(slot.name, name);
      set(slot.name, "title", name);
      write(slot.what, what);
      set(slot.what, "title", what);
      if (slot.select.dataset.menu !== menu) {
        slot.select.dataset.menu = menu;
        slot.select.innerHTML = (menus[menu] ?? [look]).map((each) => `<option>${escaped(each)}</option>`).join("");
      }
      slot.select.value = look;
      set(slot.select, "aria-label", `Format of ${device}`);
      slot.select.disabled = page.dead || (menus[menu] ?? []).length < 2;
      set(slot.bits, "hidden", width === 1 ? "" : null);
      set(slot.value, "data-bit", width === 1 ? "" : null);
    }
    const [text, bits, forced] = value;
    const past = known.get(number_);
    const spoken = shownText(text, look);
    write(slot.text, spoken);
    if (width === 1) set(slot.value, "data-on", text === "1" ? "" : null);
    else {
      const recent = past?.recent ? differing(bits, past.bits) : 0;
      const drawn = `${bits}/${width}/${recent}`;
      if (slot.bits.dataset.drawn !== drawn) {
        slot.bits.dataset.drawn = drawn;
        const { zero, one, fresh } = bitPaths(bits, width, recent);
        slot.zero.setAttribute("d", zero);
        slot.one.setAttribute("d", one);
        slot.fresh.setAttribute("d", fresh);
      }
    }
    write(slot.was, past ? `was ${shownText(past.text, look)}` : "");
    set(slot.node, "data-changed", past?.recent ? "" : null);
    set(slot.node, "data-forced", forced ? "" : null);
    write(slot.fcol, forced ? "F" : "");
    set(slot.node, "aria-label", `${device} ${name} ${spoken}${forced ? ", forced" : ""}`.replace("  ", " "));
  }
  const shownText = (text, look) => (/^(decimal|unsigned)/.test(look) ? number(text) : text.replace(/^-/, "−"));

  function lay() {
    makeSlots();
    const first = Math.max(0, Math.min(Math.floor(top / ROW_PX) - SPARE, shown[2] - slots.length));
    for (let index = first; index < first + slots.length; index++) {
      const slot = slotFor(index);
      if (slot.index !== index) {
        slot.index = index;
        slot.node.style.transform = `translateY(${index * ROW_PX}px)`;
        fill(slot);
      }
    }
    if (asked !== first && !page.dead) {
      asked = first;
      say("window", { view: id, first, count: slots.length });
    }
  }
  function look() {
    const before = top;
    [top, high] = [rows.scrollTop, rows.clientHeight];
    if (top !== before) plate.close();
    lay();
  }
  rows.addEventListener("scroll", () => work.look(look));
  const refill = () => slots.forEach((slot) => slot.index >= 0 && fill(slot));

  // What a value was before it changed, and for a moment that it has just changed.
  function note(number_, before, after) {
    if (!before || before[0] === after[0]) return;
    const past = { text: before[0], bits: before[1], recent: true };
    clearTimeout(known.get(number_)?.timer);
    past.timer = setTimeout(() => {
      past.recent = false;
      const slot = slots.find((each) => each.number === number_);
      if (slot) fill(slot);
    }, HOLD_MS);
    known.set(number_, past);
  }

  // -- keyboard and pointer -------------------------------------------------------------------------------------

  function mark() {
    refill();
    const slot = slots.find((each) => each.index === here);
    set(grid, "aria-activedescendant", slot?.number ? slot.node.id : null);
  }
  function choose(index, scroll = false) {
    here = Math.max(0, Math.min(index, shown[2] - 1));
    if (scroll) {
      const [above, below] = [here * ROW_PX, (here + 1) * ROW_PX - rows.clientHeight];
      if (above < rows.scrollTop) rows.scrollTop = above;
      else if (below > rows.scrollTop) rows.scrollTop = below;
      look();
    }
    mark();
  }
  const slotHere = () => slots.find((each) => each.index === here && each.number !== null);
  function edit() {
    const slot = slotHere();
    if (!slot) return;
    const [device, name, what, look, , , label] = state[`row.${slot.number}.of`];
    plate.open(slot.node.querySelector(".value"), { device: label, name, what, look, label: `${device} ${label}` });
  }
  function removeHere() {
    const slot = slotHere();
    if (!slot) return;
    if (state[`row.${slot.number}`][2]) say("release_row", { number: slot.number });
    else say("drop", { number: slot.number });
  }
  grid.addEventListener("keydown", (event) => {
    if (event.target !== grid || event.ctrlKey || event.metaKey || event.altKey) return;
    const pageful = Math.max(1, Math.floor(rows.clientHeight / ROW_PX) - 1);
    const steps = { ArrowUp: -1, ArrowDown: 1, PageUp: -pageful, PageDown: pageful, Home: -Infinity, End: Infinity };
    if (event.key in steps) choose(here < 0 ? 0 : here + steps[event.key], true);
    else if (event.key === "F2" || event.key === "Enter") edit();
    else if (event.key === "Delete") removeHere();
    else if (event.key === "f" || event.key === "F") slotHere()?.select.focus();
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
  rows.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" && event.key !== "Enter") return; // from the format of a row back to the rows
    event.preventDefault();
    event.stopPropagation();
    grid.focus();
  });
  grid.addEventListener("focus", () => here < 0 && shown[2] && choose(0));

  // -- adding ---------------------------------------------------------------------------------------------------

  const list = () => state[`offers.${id}`] ?? [];
  function offer() {
    const found = document.activeElement === adder || offers.contains(document.activeElement) ? list() : [];
    const open = found.length > 0 && adder.value.trim() !== "";
    offers.hidden = !open;
    set(adder, "aria-expanded", String(open));
    if (picked >= found.length) picked = -1;
    const word = adder.value.split(/[,;\s]+/).at(-1).length;
    offers.innerHTML = open
      ? found
          .map(([text, device, what], at) => `<li role="option" id="offer-${id}-${at}" data-at="${at}" aria-selected="${at === picked}"><span><b>${escaped(text.slice(0, word))}</b>${escaped(text.slice(word))}</span><span class="mono">${escaped(device)}</span><small>${escaped(what)}</small></li>`)
          .join("")
      : "";
    set(adder, "aria-activedescendant", open && picked >= 0 ? `offer-${id}-${picked}` : null);
  }
  function add(text) {
    lastAdd = ++request;
    say("add", { view: id, n: lastAdd, text });
  }
  const completed = (at) => adder.value.replace(/[^,;\s]*$/, list()[at][0]);
  adder.addEventListener("input", () => {
    picked = -1;
    find(".refused").hidden = true;
    set(adder, "aria-invalid", null);
    say("offer", { view: id, text: adder.value });
  });
  adder.addEventListener("keydown", (event) => {
    const found = offers.hidden ? 0 : list().length;
    if (event.key === "ArrowDown" && found) picked = (picked + 1) % found;
    else if (event.key === "ArrowUp" && found) picked = picked <= 0 ? found - 1 : picked - 1;
    else if (event.key === "Tab" && found && picked >= 0) adder.value = completed(picked);
    else if (event.key === "Enter") add(picked >= 0 && found ? completed(picked) : adder.value);
    else if (event.key === "Escape" && found) offers.hidden = true;
    else return;
    event.preventDefault();
    event.stopPropagation();
    if (event.key.startsWith("Arrow")) offer();
  });
  adder.addEventListener("blur", () => setTimeout(offer, 150));
  offers.addEventListener("pointerdown", (event) => {
    const option = event.target.closest("li");
    if (!option) return;
    event.preventDefault();
    add(completed(Number(option.dataset.at)));
  });
  function answered([n, refused, at]) {
    if (n !== lastAdd && !refused) return;
    const words = find(".refused");
    words.hidden = !refused;
    write(words, refused);
    set(words, "title", refused);
    set(adder, "aria-invalid", refused && n === lastAdd ? "true" : null);
    if (refused) refill(); // a format that was not taken
    else if (at) {
      adder.value = "";
      offers.hidden = true;
      tall.style.height = `${shown[2] * ROW_PX}px`;
      rows.scrollTop = Math.max(0, (at - 1) * ROW_PX - rows.clientHeight / 2);
      choose(at - 1, true);
    }
  }

  // -- order and tools ------------------------------------------------------------------------------------------

  function arrange(changed) {
    const [text, sort, down, only] = arranged;
    say("arrange", { find: text, sort, down, only, ...changed });
  }
  finder.addEventListener("input", () => arrange({ find: finder.value.trim() }));
  for (const button of body.querySelectorAll("[data-sort]"))
    button.addEventListener("click", () => {
      const [, sort, down] = arranged;
      const key = button.dataset.sort;
      arrange(sort !== key ? { sort: key, down: false } : down ? { sort: "", down: false } : { down: true });
    });
  for (const button of body.querySelectorAll("[data-only]")) button.addEventListener("click", () => arrange({ only: arranged[3] === button.dataset.only ? "" : button.dataset.only }));
  find("[data-testid=release-all]").addEventListener("click", () => say("release_all"));
  find("[data-testid=clear]").addEventListener("click", () => say(state.back ? "put_back" : "clear"));

  function tools() {
    const { count = 0, forced = 0, back = false } = state;
    write(sub, `${number(count)} watched${forced ? ` · ${number(forced)} forced` : ""}`);
    write(find(".tally"), shown[2] === count ? `${number(count)} ${count === 1 ? "device" : "devices"} watched` : `${number(shown[2])} of ${number(count)} devices shown`);
    const clear = find("[data-testid=clear]");
    write(clear, back ? "Put back" : "Clear");
    clear.disabled = page.dead || (!count && !back);
    find("[data-testid=release-all]").disabled = page.dead || !forced;
    write(find("[data-only=forced]"), forced ? `Forced ${number(forced)}` : "Forced");
    for (const button of body.querySelectorAll("[data-only]")) set(button, "aria-pressed", String(arranged[3] === button.dataset.only));
    for (const button of body.querySelectorAll("[data-sort]")) {
      const way = arranged[1] !== button.dataset.sort ? "none" : arranged[2] ? "descending" : "ascending";
      set(button.parentElement, "aria-sort", way);
    }
    const nothing = find(".nothing");
    nothing.hidden = shown[2] > 0;
    rows.hidden = shown[2] === 0;
    write(nothing, count ? "No row is like that." : "Nothing is watched. Type a name, a device or a range above.");
  }

  const sizes = new ResizeObserver(() => work.look(look));
  sizes.observe(rows);

  return {
    apply(changes, now) {
      const touched = new Set();
      let others = false; // what is not of a row
      for (const key of Object.keys(changes)) {
        const [kind, text, of] = key.split(".");
        if (kind !== "row") {
          others = true;
          continue;
        }
        const number_ = Number(text);
        touched.add(number_);
        if (of) continue;
        if (now[key]) note(number_, state[key], now[key]);
        else known.delete(number_);
      }
      state = { ...now };
      for (const [key, value] of Object.entries(now)) if (value === null) delete now[key]; // rows out of sight are forgotten
      const mine = `shown.${id}` in now ? `shown.${id}` : Object.keys(now).find((key) => key.startsWith("shown."));
      if (mine && (changes[mine] || shown !== now[mine])) {
        shown = now[mine];
        tall.style.height = `${shown[2] * ROW_PX}px`;
        rows.style.height = `${Math.min(shown[2], SHOWN) * ROW_PX}px`;
        set(grid, "aria-rowcount", shown[2] + 1);
        if (here >= shown[2]) here = shown[2] - 1;
      }
      if (changes.as) {
        arranged = changes.as;
        if (document.activeElement !== finder) finder.value = arranged[0];
      }
      if (others) tools();
      lay();
      for (const slot of slots) if (slot.index >= 0 && (others || slot.number === null || touched.has(slot.number))) fill(slot);
      if (changes[`offers.${id}`]) offer();
      if (changes[`said.${id}`]) answered(changes[`said.${id}`]);
      plate.show(now);
    },
    rest(dead) {
      if (dead) plate.close();
      asked = null;
      for (const node of body.querySelectorAll("input, .tool, [data-sort]")) node.disabled = dead;
      for (const slot of slots) slot.shape = "";
      tools();
      lay();
      refill();
    },
    close() {
      sizes.disconnect();
      work.drop(look);
      plate.end();
      for (const past of known.values()) clearTimeout(past.timer);
    },
  };
};
