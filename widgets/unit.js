// The unit's face: a switch or button for each input, the window with its lamps, the mode switch, the potentiometers, and the analog
// terminals: a number and a slider for each input, what each output gives.

const CAP = {
  switch: `<svg class="sw slide" width="26" height="46" viewBox="0 0 26 46" aria-hidden="true"><rect class="slot" x="1.5" y="1.5" width="23" height="43" rx="4"/><rect class="lit" x="3" y="22" width="20" height="21" rx="3"/><path class="mark i" d="M13 29v8"/><circle class="mark o" cx="13" cy="13" r="4"/><g class="move"><rect class="cap" x="3.5" y="3.5" width="19" height="20" rx="3"/><path class="grip" d="M8 10.5h10M8 13.5h10M8 16.5h10"/></g></svg>`,
  push: `<svg class="sw push" width="38" height="38" viewBox="0 0 38 38" aria-hidden="true"><circle class="slot" cx="19" cy="19" r="17"/><circle class="lit" cx="19" cy="19" r="16"/><circle class="cap" cx="19" cy="19" r="12.5"/></svg>`,
  latch: `<svg class="sw push" width="38" height="38" viewBox="0 0 38 38" aria-hidden="true"><circle class="slot" cx="19" cy="19" r="17"/><circle class="lit" cx="19" cy="19" r="16"/><circle class="cap" cx="19" cy="19" r="12.5"/><path class="mark" d="M19 15.5v7M15.5 22.5h7"/></svg>`,
  stop: `<svg class="sw push" width="38" height="38" viewBox="0 0 38 38" aria-hidden="true"><circle class="slot" cx="19" cy="19" r="17"/><circle class="lit" cx="19" cy="19" r="16"/><circle class="cap stop" cx="19" cy="19" r="14"/><path class="stop-ring" d="M12.5 19a6.5 6.5 0 0 1 11-4.7m.3-2.6v3h-3M25.5 19a6.5 6.5 0 0 1-11 4.7m-.3 2.6v-3h3"/></svg>`,
  machine: `<svg class="sw plant" width="38" height="38" viewBox="0 0 38 38" aria-hidden="true"><circle class="ring" cx="19" cy="19" r="15"/><path class="sense" d="M11.5 24.5h15l-7.5-12z"/></svg>`,
};
const WORD = {
  switch: "switch",
  push: "push button",
  latch: "latching button",
  stop: "emergency stop",
  machine: "driven by the machine",
  stuck: "taken over by hand, stuck",
};
const LAMP = `<svg class="lamp" width="26" height="11" viewBox="0 0 26 11" aria-hidden="true"><rect x="1" y="1" width="24" height="9" rx="2"/><path class="pulse" d="M0.5 10.25h9V.75h7v9.5h9"/></svg>`;
const SCREW = (at) =>
  `<svg class="screw" width="14" height="14" viewBox="0 0 14 14" aria-hidden="true"><circle cx="7" cy="7" r="5.5"/><line x1="3" y1="7" x2="11" y2="7" transform="rotate(${((at * 37) % 97) - 45} 7 7)"/></svg>`;

const KNOB = `<svg class="knob" width="104" height="84" viewBox="10 0 104 84" aria-hidden="true"><circle class="skirt" cx="62" cy="50" r="29"/><circle class="body" cx="62" cy="50" r="23"/><line class="tick" x1="36.8" y1="30.3" x2="33.6" y2="27.8"/><text class="t-on" x="32" y="24.6" text-anchor="end">ON</text><line class="tick" x1="62" y1="18" x2="62" y2="14.5"/><text class="t-tm" x="62" y="10.5" text-anchor="middle">TM</text><line class="tick" x1="87.2" y1="30.3" x2="90.4" y2="27.8"/><text class="t-off" x="92" y="24.6" text-anchor="start">OFF</text><line class="hand" x1="55.7" y1="45.1" x2="47" y2="38.3"/></svg>`;
const POSITIONS = ["ON", "TM", "OFF"];
const [POT_MAX, POT_TURN] = [255, 270]; // a potentiometer's greatest value, and the degrees from 0 to it
const POT = (at) => {
  const ticks = Array.from({ length: 11 }, (_, tick) => `<line class="tick" x1="38" y1="${tick === 5 ? 4 : 6}" x2="38" y2="9" transform="rotate(${tick * 27 - 135} 38 32)"/>`).join("");
  return `<svg class="knob pot" width="56" height="84" viewBox="10 0 56 92" aria-hidden="true">${ticks}<circle class="body" cx="38" cy="32" r="18"/><line class="hand" x1="38" y1="27" x2="38" y2="19"/><text class="value" x="38" y="73" text-anchor="middle">0</text><text x="38" y="87" text-anchor="middle">POT ${at}</text></svg>`;
};

const UNITS = { V: "V", mA: "mA", C: "°C" };
const FINE = { V: 0.01, mA: 0.01, C: 0.1 }; // what a slider moves by

panels.unit = (place, layout, page, view) => {
  const { inputs = [], outputs = [], model = "", pots = 0, analog = [] } = layout;
  const points = new Map([...inputs, ...outputs].map((point) => [point.device, point]));
  let state = {};
  let wide = null;
  const plate = platesOf("unit", page, view, { closed: () => select(null) });

  const title = (point) => `${point.device} ${point.name}`.trim();
  const rows = (list, count) => Array.from({ length: Math.ceil(list.length / count) }, (_, at) => list.slice(at * count, at * count + count));

  function build(count) {
    const screws = (shift) => Array.from({ length: count }, (_, at) => SCREW(at + shift)).join("");
    let row = 0;
    const head = (point, at) => `
      <div class="point${at % 4 === 0 && at ? " group" : ""}" data-point="${point.device}" title="${escaped(point.name.length > 8 ? point.name : point.what)}">
        <span class="addr">${point.device}</span><span class="name">${escaped(point.name) || "&nbsp;"}</span>`;
    const ins = rows(inputs, count)
      .map((list) => {
        const here = row++;
        const cells = list.map((point, at) => `${head(point, at)}<button class="control" data-testid="${point.device}" data-row="${here}" data-col="${at}" tabindex="-1"></button></div>`);
        return `<div class="cols ins">${cells.join("")}</div>`;
      })
      .join("");
    const lamp = (point, here, at) => `
      <span class="lampcell" role="img" data-testid="lamp-${point.device}" data-lamp="${point.device}" data-row="${here}" data-col="${at}" tabindex="-1">${LAMP}<span class="no">${point.device.slice(1)}</span></span>`;
    const status = (word, at) => `
      <span class="lampcell status" role="img" data-testid="lamp-${word}" data-status="${word}" style="grid-column:${at}"><svg class="lamp" width="14" height="14" viewBox="0 0 14 14" aria-hidden="true"><circle cx="7" cy="7" r="5.5"/></svg><span class="no word">${word}</span></span>`;
    const window_ = [
      ...rows(inputs, count).map((list) => ["IN", list, false]),
      ...rows(outputs, count).map((list, at, all) => ["OUT", list, at === all.length - 1]),
    ];
    // The last row of outputs has room for the three lamps, or they take a row of their own.
    if (window_.at(-1)[1].length > count - 3) {
      window_.at(-1)[2] = false;
      window_.push(["", [], true]);
    }
    const glass = window_
      .map(([side, list, last]) => {
        const here = row++;
        const lamps = last ? ["RUN", "ERR", "BAT"].map((word, at) => status(word, count - 2 + at)).join("") : "";
        return `<div class="cols row"><span class="side" aria-hidden="true">${side}</span>${list.map((point, at) => lamp(point, here, at)).join("")}${lamps}</div>`;
      })
      .join("");
    const outRows = rows(outputs, count);
    if (outRows.at(-1).length > count - 2 - pots) outRows.push([]);
    const outs = outRows
      .map((list, at) => {
        const last = at === outRows.length - 1;
        const from = count - 1 - pots;
        const keys = POSITIONS.map((position, key) => `<button class="knobkey" role="radio" data-mode="${position}" data-testid="mode-${position}" data-row="${row}" data-col="${from - 1 + key}" tabindex="-1" style="left:${(key * 100) / 3}%">${position}</button>`);
        const knob = last ? `<div class="knobcell" style="grid-column:${from}/span 2" role="radiogroup" aria-label="Mode switch" data-testid="mode">${KNOB}${keys.join("")}</div>${potentiometers(from + 2)}` : "";
        const brand = last ? `<div class="brand plate"><b>${escaped(model)}</b>${inputs.length} in · ${outputs.length} out<span class="stamp"></span></div>` : "";
        return `<div class="cols outs${last ? " last" : ""}">${list.map((point, col) => `${head(point, col)}</div>`).join("")}${knob}${brand}</div>`;
      })
      .join("");
    function potentiometers(column) {
      return Array.from({ length: pots }, (_, at) => `<div class="knobcell potcell" style="grid-column:${column + at}" role="slider" tabindex="0" aria-label="Potentiometer ${at}" aria-valuemin="0" aria-valuemax="${POT_MAX}" data-pot="${at}" data-testid="pot-${at}">${POT(at)}</div>`).join("");
    }
    place.innerHTML = `
      <section class="unit" aria-label="${escaped(model)}, inputs and outputs" data-testid="unit" style="--ec-columns:${count}">
        <div class="cols strip top">${screws(0)}</div>${ins}<div class="glass">${glass}</div>${outs}${signals()}<div class="cols strip bottom">${screws(5)}</div>
      </section>`;
    roving(place.firstElementChild, () => [...place.querySelectorAll("[data-row]")]);
    for (const button of place.querySelectorAll(".control")) operate(button);
    for (const cell of place.querySelectorAll(".signal.in")) wire(cell);
    for (const cell of place.querySelectorAll(".lampcell[data-lamp]")) cell.addEventListener("click", () => open(cell.dataset.lamp));
    for (const name of place.querySelectorAll(".point .name, .point .addr")) name.addEventListener("click", () => open(name.parentElement.dataset.point));
    for (const pot of place.querySelectorAll(".potcell")) turn(pot);
    for (const radio of place.querySelectorAll(".knobkey")) radio.addEventListener("click", () => page.say("unit", "mode", { mode: radio.dataset.mode }));
    place.firstElementChild.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && event.target.dataset.lamp) {
        event.preventDefault();
        open(event.target.dataset.lamp);
      }
    });
    show(state);
    rest(page.dead);
    view.stamp();
  }
  function rest(dead) {
    if (dead) plate.close();
    for (const button of place.querySelectorAll(".control, .knobkey, .potcell")) set(button, "aria-disabled", dead ? "true" : null);
    if (wide !== null) for (const { device } of analog) signal(device);
  }

  // A control says what the hand did and waits for the unit to tell what came of it.
  function operate(button) {
    const device = button.dataset.testid;
    const tell = (verb, values) => page.say("unit", verb, { device, ...values });
    const isPush = () => button.dataset.kind === "push";
    button.addEventListener("click", () => {
      if (isPush()) return;
      if (button.dataset.kind === "stuck") tell("free");
      else tell("set", { on: state[device] ? 0 : 1 });
    });
    let held = false;
    const hold = (down) => {
      if (down === held || !isPush()) return;
      held = down;
      tell(down ? "press" : "release");
    };
    button.addEventListener("pointerdown", (event) => {
      if (event.button) return;
      button.setPointerCapture(event.pointerId);
      hold(true);
    });
    for (const end of ["pointerup", "pointercancel", "lostpointercapture", "blur"]) button.addEventListener(end, () => hold(false));
    button.addEventListener("keydown", (event) => isPush() && !event.repeat && (event.key === " " || event.key === "Enter") && hold(true));
    button.addEventListener("keyup", (event) => isPush() && (event.key === " " || event.key === "Enter") && hold(false));
    button.addEventListener("contextmenu", (event) => isPush() && event.preventDefault());
  }

  function control(device) {
    const button = place.querySelector(`.control[data-testid="${device}"]`);
    const point = points.get(device);
    const by = state[`${device}.by`] ?? "hand";
    const kind = by === "hand" ? point.control : by;
    const drawn = kind === "stuck" ? "machine" : kind;
    if (button.dataset.kind !== kind) {
      button.dataset.kind = kind;
      if (button.dataset.drawn !== drawn) {
        button.dataset.drawn = drawn;
        button.innerHTML = CAP[drawn];
      }
      set(button, "role", kind === "push" ? null : "switch");
      set(button, kind === "push" ? "aria-checked" : "aria-pressed", null);
      set(button, "aria-label", `${title(point)} ${WORD[kind]}`);
      set(button, "title", kind === "machine" ? "driven by the machine; press to take it over" : kind === "stuck" ? "stuck; press to give it back to the machine" : null);
    }
    set(button, kind === "push" ? "aria-pressed" : "aria-checked", String(Boolean(state[device])));
  }

  // -- analog terminals

  function signals() {
    const cells = analog.map(({ device, name, what, module }) => {
      const into = device[1] === "I";
      const label = escaped(`${device} ${name}`.trim());
      const value = into
        ? `<input class="mono" data-testid="signal-${device}" aria-label="${label}" spellcheck="false" autocomplete="off" inputmode="decimal">`
        : `<output class="mono" data-testid="signal-${device}" aria-label="${label}"></output>`;
      const ruler = into
        ? `<input type="range" data-testid="slider-${device}" aria-label="${label}, slider">`
        : '<span class="meter" aria-hidden="true"><i></i></span>';
      return `
        <div class="signal ${into ? "in" : "out"}" data-signal="${device}" title="${escaped([what, module].filter(Boolean).join(", "))}">
          <p><span class="addr">${device}</span><span class="name">${escaped(name || module)}</span></p>
          <p>${value}<span class="kind"></span><span class="by"></span><button class="give" data-testid="free-${device}" title="held by hand; press to give it back to the machine" hidden>held · free</button></p>
          ${ruler}<p class="ends" aria-hidden="true"><span></span><span></span></p><p class="refused" role="alert" hidden></p>
        </div>`;
    });
    return analog.length ? `<div class="analog" role="group" aria-label="Analog terminals">${cells.join("")}</div>` : "";
  }

  const written = (value) => (value === null ? "" : String(Number(value.toPrecision(6))));
  function signal(device) {
    const cell = place.querySelector(`[data-signal="${device}"]`);
    const [value, unit, ends, by] = state[device] ?? [null, "", null, "hand"];
    const away = !state[device];
    const into = device[1] === "I";
    set(cell, "data-none", value === null ? "" : null);
    write(cell.querySelector(".kind"), UNITS[unit] ?? "");
    write(cell.querySelector(".by"), away ? "no module" : by === "machine" ? "machine" : by === "stuck" || ends ? "" : "off");
    cell.querySelector(".give").hidden = by !== "stuck" || page.dead;
    const [low, high] = ends ?? [0, 0];
    for (const [node, end] of [...cell.querySelectorAll(".ends span")].map((node, at) => [node, at ? high : low])) write(node, ends ? written(end).replace("-", "−") : "");
    if (!into) {
      write(cell.querySelector("output"), (away ? "" : value.toFixed(unit === "V" ? 3 : 2)).replace("-", "−"));
      const [from, to] = ends ? [Math.min(Math.max(0, low), value), Math.max(Math.max(0, low), value)].map((each) => (each - low) / (high - low)) : [0, 0];
      cell.querySelector(".meter i").style.cssText = `left:${100 * from}%;width:${100 * (to - from)}%`;
      return;
    }
    const [field, slider] = cell.querySelectorAll("input");
    field.disabled = page.dead || away;
    slider.disabled = page.dead || !ends;
    if (document.activeElement !== field || cell.dataset.typed === undefined) {
      field.value = written(value);
      field.placeholder = unit === "C" ? "broken" : "none";
    }
    if (!ends) return;
    for (const [name, each] of Object.entries({ min: low, max: high, step: FINE[unit] })) set(slider, name, each);
    if (cell.dataset.pulled === undefined) slider.value = value ?? Math.max(0, low);
    set(slider, "aria-valuetext", value === null ? "no signal" : `${written(value)} ${UNITS[unit]}`);
  }

  // What was typed is put on the terminal by Enter or when the field is left; a slider's many moves in one frame are one message.
  function wire(cell) {
    const device = cell.dataset.signal;
    const [field, slider] = cell.querySelectorAll("input");
    const refused = cell.querySelector(".refused");
    const name = () => `${device}:${state[device]?.[1]}`;
    const tell = (words) => {
      write(refused, words);
      refused.hidden = !words;
      set(field, "aria-invalid", words ? "true" : null);
    };
    const put = (text, heard = () => {}) =>
      page.request("unit", "signal", { name: name(), text }, (words) => {
        tell(words ?? "");
        heard(words);
      });
    const take = () => {
      if (cell.dataset.typed === undefined) return;
      const text = field.value;
      put(text, (words) => {
        if (words || field.value !== text) return;
        delete cell.dataset.typed;
        signal(device);
      });
    };
    field.addEventListener("input", () => (cell.dataset.typed = ""));
    field.addEventListener("change", take);
    field.addEventListener("keydown", (event) => {
      event.stopPropagation();
      if (event.key === "Enter") take();
      if (event.key !== "Escape") return;
      delete cell.dataset.typed;
      tell("");
      signal(device);
    });
    let sending;
    slider.addEventListener("input", () => {
      cell.dataset.pulled = "";
      delete cell.dataset.typed;
      sending ??= requestAnimationFrame(() => {
        sending = undefined;
        put(slider.value);
      });
    });
    slider.addEventListener("change", () => delete cell.dataset.pulled);
    cell.querySelector(".give").addEventListener("click", () => page.say("unit", "free_signal", { name: name() }));
  }

  function lampOf(device) {
    const cell = place.querySelector(`.lampcell[data-lamp="${device}"]`);
    const on = state[device[0] === "X" ? `${device}.seen` : device];
    const forced = state[`${device}.forced`];
    const isForced = forced === 0 || forced === 1;
    set(cell, "data-on", on ? "" : null);
    set(cell, "data-forced", isForced ? "" : null);
    set(place.querySelector(`.point[data-point="${device}"]`), "data-forced", isForced ? "" : null);
    const badge = cell.querySelector(".f");
    if (isForced && !badge) cell.insertAdjacentHTML("beforeend", '<span class="badge-f f">F</span>');
    if (!isForced && badge) badge.remove();
    set(cell, "aria-label", `${title(points.get(device))} ${on ? "on" : "off"}${isForced ? ", forced" : ""}`);
  }

  function show(changes) {
    if (wide === null) return;
    const touched = new Set(Object.keys(changes).map((key) => key.split(".")[0]));
    for (const device of touched) {
      const point = points.get(device);
      if (!point) continue;
      if (device[0] === "X") control(device);
      lampOf(device);
    }
    for (const { device } of analog) if (device in changes) signal(device);
    for (const cell of place.querySelectorAll(".lampcell.status")) {
      const word = cell.dataset.status;
      const lamp = state[word] ?? "off";
      set(cell, "data-on", lamp === "off" ? null : word === "RUN" ? "" : "fault");
      set(cell, "data-flashing", lamp === "flashing" ? "" : null);
      set(cell, "aria-label", `${word} lamp ${lamp}`);
    }
    for (const radio of place.querySelectorAll(".knobkey")) set(radio, "aria-checked", String(radio.dataset.mode === state.switch));
    set(place.querySelector("[data-testid=mode]"), "data-mode", state.switch);
    for (const pot of place.querySelectorAll(".potcell")) {
      const value = state[`pot${pot.dataset.pot}`] ?? 0;
      set(pot, "aria-valuenow", value);
      pot.querySelector(".hand").style.transform = `rotate(${(value / POT_MAX) * POT_TURN - POT_TURN / 2}deg)`;
      write(pot.querySelector(".value"), String(value));
    }
  }

  // A potentiometer follows the pointer around it, or the keys; many moves in one frame are one message.
  function turn(pot) {
    const number_ = Number(pot.dataset.pot);
    let wanted = null;
    let sending;
    const put = (value) => {
      wanted = Math.max(0, Math.min(POT_MAX, Math.round(value)));
      sending ??= requestAnimationFrame(() => {
        sending = undefined;
        page.say("unit", "pot", { number: number_, value: wanted });
      });
    };
    const toward = (event) => {
      const box = pot.querySelector(".body").getBoundingClientRect();
      const degrees = (Math.atan2(event.clientX - box.left - box.width / 2, box.top + box.height / 2 - event.clientY) * 180) / Math.PI;
      put(((Math.max(-POT_TURN / 2, Math.min(POT_TURN / 2, degrees)) + POT_TURN / 2) / POT_TURN) * POT_MAX);
    };
    pot.addEventListener("pointerdown", (event) => {
      if (event.button || page.dead) return;
      pot.setPointerCapture(event.pointerId);
      toward(event);
    });
    pot.addEventListener("pointermove", (event) => pot.hasPointerCapture(event.pointerId) && toward(event));
    pot.addEventListener("keydown", (event) => {
      const now = wanted !== null && sending ? wanted : (state[`pot${number_}`] ?? 0);
      const steps = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1, PageUp: 16, PageDown: -16, Home: -POT_MAX, End: POT_MAX };
      if (!(event.key in steps) || event.ctrlKey || event.metaKey || event.altKey) return;
      event.preventDefault();
      event.stopPropagation();
      put(now + steps[event.key]);
    });
  }

  function select(device) {
    for (const point of place.querySelectorAll(".point[data-selected]")) set(point, "data-selected", null);
    if (device) set(place.querySelector(`.point[data-point="${device}"]`), "data-selected", "");
  }
  function open(device) {
    const { name, what } = points.get(device);
    plate.open(place.querySelector(`.lampcell[data-lamp="${device}"]`), { device, name, what });
    if (plate.label === device) select(device);
  }

  // 16 columns need 816 px; below that the unit takes rows of eight.
  const fit = () => {
    const now = place.clientWidth >= 760;
    if (!place.clientWidth || now === wide) return;
    wide = now;
    plate.close();
    build(wide ? 16 : 8);
  };
  const sizes = new ResizeObserver(fit);
  sizes.observe(place);
  requestAnimationFrame(fit);

  return {
    apply(changes, now) {
      state = now;
      show(changes);
      plate.show(now);
    },
    pulsed(devices) {
      for (const device of devices) {
        const cell = place.querySelector(`.lampcell[data-lamp="${device}"]`);
        if (!cell) continue;
        set(cell, "data-pulsed", "");
        clearTimeout(cell.pulse);
        cell.pulse = setTimeout(() => set(cell, "data-pulsed", null), HOLD_MS);
      }
    },
    rest,
    close() {
      sizes.disconnect();
      plate.end();
    },
  };
};
