// The program as text. A textarea takes what is typed, so that the browser's own selection and input methods work; the coloured
// text lies above it, line for line. The kernel answers what was typed with problems, completions and operands.

const TYPED_MS = 120; // how long typing must rest before the kernel is asked
const TYPED_PER_MS = 200; // a long text is asked about more seldom: a millisecond more for so many letters
const JOIN_MS = 600; // letters that follow one another so fast are undone together
const [LINE_EM, SPARE_LINES] = [1.5, 40]; // the height of a line; lines that are drawn above and below what is in sight

// Of two lists of lines how many are the same at the begin and at the end.
function sameEnds(before, after) {
  const most = Math.min(before.length, after.length);
  let head = 0;
  while (head < most && before[head] === after[head]) head += 1;
  let tail = 0;
  while (tail < most - head && before[before.length - 1 - tail] === after[after.length - 1 - tail]) tail += 1;
  return [head, tail];
}

// A line in its colours, with a wavy line below what is wrong in it and the sentence behind it.
function lineMarkup(tokens, marks) {
  const edges = marks.flatMap(([, column, length]) => [column - 1, column - 1 + length]);
  const spoilt = (at) => marks.some(([, column, length]) => at >= column - 1 && at < column - 1 + length);
  let markup = "";
  let at = 0;
  for (const [kind, text] of tokens) {
    const cuts = [0, ...edges.map((edge) => edge - at).filter((cut) => cut > 0 && cut < text.length), text.length].sort((a, b) => a - b);
    for (let piece = 1; piece < cuts.length; piece += 1) {
      const part = text.slice(cuts[piece - 1], cuts[piece]);
      if (part) markup += `<span class="${kind}${spoilt(at + cuts[piece - 1]) ? " wavy" : ""}">${escaped(part)}</span>`;
    }
    at += text.length;
  }
  if (marks.some(([, column]) => column - 1 >= at)) markup += '<span class="wavy"> </span>';
  return `${markup}${marks.length ? `<span class="why">${escaped(marks.map(([, , , words]) => words).join(" · "))}</span>` : ""}`;
}

panels.editor = (place, layout, page, view) => {
  // The panels are built anew with each program; the editor stays, with its cursor and its undo.
  if (view.editor) {
    place.append(view.editor.section);
    view.editor.renew(layout);
    return view.editor;
  }
  const { section, body, sub } = frame(place, {
    title: "Program",
    key: "editor",
    tools: `<button class="tool" data-testid="drop" title="Show the program of the PLC again">${icon("reset")}Revert</button>
      <button class="btn lit" data-testid="download" title="Download, as a change in RUN where that is allowed (Ctrl+Enter)">${icon("run", 14)}Download</button>`,
  });
  section.classList.add("editor");
  body.innerHTML = `
    <div class="sheet scroll"><div class="gutter" aria-hidden="true"></div>
      <div class="stack"><div class="ec il over" aria-hidden="true"></div>
        <textarea spellcheck="false" autocapitalize="off" autocomplete="off" wrap="off" data-testid="text" aria-label="Program as instruction list" aria-autocomplete="list"></textarea>
        <ul class="offers" role="listbox" aria-label="Completions" data-testid="offers" hidden></ul></div></div>
    <p class="operands" data-testid="operands"></p>
    <ol class="problems" data-testid="problems" aria-label="Problems"></ol>
    <p class="verdict" role="status" data-testid="verdict"></p>`;
  const find = (selector) => section.querySelector(selector);
  const [sheet, gutter, over, area, offers, operands, problems, verdict] = [".sheet", ".gutter", ".over", "textarea", ".offers", ".operands", ".problems", ".verdict"].map(find);

  let source = layout.source;
  let asked = 0;
  let wants = false; // completions were asked for by a key
  let help = {};
  let offered = [];
  let chosen = -1;
  let lines = [];
  let opens = []; // what each line leaves open
  let marked = new Map(); // line -> its marks
  let drawn = [0, 0]; // the first line that is drawn, and the one behind the last

  // -- the text and its colours --------------------------------------------------------------------------------------

  function paint(force) {
    const current = area.value.split("\n");
    const [head, tail] = force ? [0, 0] : sameEnds(lines, current);
    const end = lines.length - tail;
    let open = head ? opens[head - 1] : undefined;
    const left = [];
    const leave = (line) => (open = ilTokens(current[line], open).open);
    for (let line = head; line < current.length - tail; line += 1) left.push(leave(line));
    // A comment or table that is opened or closed changes the lines below it.
    let line = current.length - tail;
    const same = (a = IL_BEGIN, b = IL_BEGIN) => a.comment === b.comment && a.table === b.table;
    let former = opens[end - 1];
    opens.splice(head, end - head, ...left);
    for (; line < current.length && !same(former, open); line += 1) {
      former = opens[line];
      opens[line] = leave(line);
    }
    lines = current;
    const longest = lines.reduce((most, each) => Math.max(most, each.includes("\t") ? 4 * each.length : each.length), 0);
    over.parentElement.style.minWidth = `${longest + 2}ch`;
    draw();
  }
  // Of a long text only what is in sight is drawn, and some lines around it.
  const lineHeight = () => parseFloat(getComputedStyle(over).lineHeight) || 19.5;
  function draw() {
    const high = lineHeight();
    const first = Math.max(0, Math.floor(sheet.scrollTop / high) - SPARE_LINES);
    const last = Math.min(lines.length, first + Math.ceil((sheet.clientHeight || 560) / high) + 2 * SPARE_LINES);
    const [numbers, texts] = [[], []];
    for (let line = first; line < last; line += 1) {
      const marks = marked.get(line + 1) ?? [];
      numbers.push(`<div class="no"${marks.length ? " data-bad" : ""}>${line + 1}</div>`);
      texts.push(`<div class="ln">${lineMarkup(ilTokens(lines[line], line ? opens[line - 1] : undefined).tokens, marks) || " "}</div>`);
    }
    gutter.innerHTML = numbers.join("");
    over.innerHTML = texts.join("");
    drawn = [first, last];
    const [above, all] = [LINE_EM * first, LINE_EM * (lines.length + 1)];
    Object.assign(over.style, { paddingTop: `${above}em`, height: `max(9em, ${all}em)` });
    Object.assign(gutter.style, { paddingTop: `calc(8px + ${above}em)`, minHeight: `calc(16px + ${all}em)` });
  }
  function sight(line) {
    const [high, top] = [lineHeight(), over.parentElement.offsetTop + line * lineHeight()];
    if (top < sheet.scrollTop) sheet.scrollTop = top;
    else if (top + high > sheet.scrollTop + sheet.clientHeight) sheet.scrollTop = top + high - sheet.clientHeight;
  }
  sheet.addEventListener("scroll", () => {
    const high = lineHeight();
    const [first, last] = [Math.floor(sheet.scrollTop / high), Math.ceil((sheet.scrollTop + sheet.clientHeight) / high)];
    if (first < drawn[0] || Math.min(last, lines.length) > drawn[1]) draw();
  });
  function mark(list) {
    marked = new Map();
    for (const one of list) marked.set(one[0], [...(marked.get(one[0]) ?? []), one]);
    draw();
    set(area, "aria-invalid", list.length ? "true" : null);
    problems.hidden = !list.length;
    problems.innerHTML = list
      .map(([line, column, , words, manual], at) => `<li><button data-at="${at}">${icon("cross", 12)}<b>line ${line}</b> ${escaped(words)}${manual ? ` <span class="dim">manual ${escaped(manual)}</span>` : ""}</button></li>`)
      .join("");
    [...problems.querySelectorAll("button")].forEach((button, at) => button.addEventListener("click", () => go(list[at][0], list[at][1])));
  }
  function go(line, column) {
    const at = lines.slice(0, line - 1).reduce((sum, text) => sum + text.length + 1, 0) + column - 1;
    area.focus({ preventScroll: true });
    area.setSelectionRange(at, at);
    sight(line - 1);
  }
  const dirty = () => area.value !== source;
  function tell() {
    write(sub, `${layout.model} · ${layout.about}${dirty() ? " · changed, not downloaded" : ""}`);
    find('[data-testid="drop"]').disabled = !dirty();
    find('[data-testid="download"]').disabled = page.dead;
  }

  // -- undo: the browser's own forgets when the panels are built anew -------------------------------------------------

  const past = [];
  const future = [];
  const present = () => ({ text: area.value, at: [area.selectionStart, area.selectionEnd] });
  let now = { text: "", at: [0, 0] };
  let last = { kind: "", when: 0 };
  function remember(kind) {
    const when = performance.now();
    const joined = kind === "insertText" && last.kind === kind && when - last.when < JOIN_MS && !/\s/.test(area.value[area.selectionStart - 1] ?? "");
    if (!joined) past.push(now);
    now = present();
    last = { kind, when };
    future.length = 0;
  }
  function travel(from, to) {
    if (!from.length) return;
    to.push(now);
    now = from.pop();
    last = { kind: "", when: 0 };
    area.value = now.text;
    area.setSelectionRange(...now.at);
    typed();
    sight(now.text.slice(0, now.at[0]).split("\n").length - 1);
  }

  // -- talking with the kernel ---------------------------------------------------------------------------------------

  let resting;
  function typed() {
    paint();
    tell();
    close();
    for (const other of page.views) if (other.editor && other !== view) other.editor.follow(area.value);
    clearTimeout(resting);
    resting = setTimeout(ask, Math.max(TYPED_MS, area.value.length / TYPED_PER_MS));
  }
  function ask() {
    clearTimeout(resting);
    asked += 1;
    page.say("editor", "typed", { text: area.value, at: area.selectionStart, n: asked });
  }
  function run() {
    clearTimeout(resting);
    close();
    asked += 1;
    if (page.dead) return;
    page.say("editor", "run", { text: area.value, n: asked });
  }
  function drop() {
    replace(0, area.value.length, source);
    page.say("editor", "drop");
    mark([]);
    write(verdict, "");
    area.focus();
  }
  function replace(from, to, text) {
    area.setRangeText(text, from, to, "end");
    remember("replace");
    typed();
  }

  // -- completion ----------------------------------------------------------------------------------------------------

  function open() {
    const word = area.value.slice(help.from, area.selectionStart);
    offered = help.options ?? [];
    chosen = -1;
    if (!offered.length || (!word && !wants) || document.activeElement !== area) return close();
    const before = area.value.slice(0, help.from);
    offers.innerHTML = offered.map(([text, kind, about], at) => `<li role="option" id="${offersId}-${at}" data-at="${at}" aria-selected="false"><span class="${kind}">${escaped(text)}</span><span class="dim">${escaped(about)}</span></li>`).join("");
    offers.style.left = `${before.length - before.lastIndexOf("\n") - 1}ch`;
    offers.hidden = false;
    const line = lineHeight();
    const below = (before.split("\n").length - 1) * line;
    const room = sheet.scrollTop + sheet.clientHeight - offers.parentElement.offsetTop - below - line;
    const above = offers.offsetHeight > room && below - offers.offsetHeight >= 0;
    offers.style.top = `${above ? below - offers.offsetHeight : below + line}px`;
  }
  function close() {
    offers.hidden = true;
    wants = false;
    set(area, "aria-activedescendant", null);
  }
  function choose(at) {
    chosen = (at + offered.length) % offered.length;
    [...offers.children].forEach((node, place) => set(node, "aria-selected", String(place === chosen)));
    set(area, "aria-activedescendant", `${offersId}-${chosen}`);
    offers.children[chosen].scrollIntoView({ block: "nearest" });
  }
  function accept(at) {
    const [text] = offered[at];
    close();
    replace(help.from, area.selectionStart, text);
  }
  const offersId = `offers${++Drawing.count}`;
  offers.addEventListener("pointerdown", (event) => {
    event.preventDefault(); // the text keeps the focus
    const option = event.target.closest("li");
    if (option) accept(Number(option.dataset.at));
  });

  function sign() {
    const line = help.signature;
    operands.innerHTML = line
      ? `<b class="mono">${escaped(line.mnemonic)}</b> ${line.operands.map(([name], at) => (at === line.at ? `<b class="mono here">${escaped(name)}</b>` : `<span class="mono">${escaped(name)}</span>`)).join(" ")}
         <span class="dim">${escaped(line.operands[line.at]?.[1] ?? line.title)} · manual ${escaped(line.section)}</span>`
      : "";
  }

  // -- keys ----------------------------------------------------------------------------------------------------------

  area.addEventListener("input", (event) => {
    remember(event.inputType);
    write(verdict, "");
    set(verdict, "data-refused", null);
    typed();
  });
  area.addEventListener("beforeinput", (event) => {
    if (!/^history/.test(event.inputType)) return;
    event.preventDefault();
    if (event.inputType === "historyUndo") travel(past, future);
    else travel(future, past);
  });
  area.addEventListener("blur", close);
  area.addEventListener("keydown", (event) => {
    event.stopPropagation();
    const { key } = event;
    const command = (event.ctrlKey || event.metaKey) && key.toLowerCase();
    if (command === "y" || (command === "z" && event.shiftKey)) travel(future, past);
    else if (command === "z") travel(past, future);
    else if (key === "Enter" && (event.ctrlKey || event.metaKey || event.shiftKey)) run();
    else if (key === " " && event.ctrlKey) {
      wants = true;
      ask();
    } else if (offers.hidden) return;
    else if (key === "ArrowDown" || key === "ArrowUp") choose(chosen < 0 && key === "ArrowUp" ? -1 : chosen + (key === "ArrowDown" ? 1 : -1));
    else if (key === "Tab" && !event.shiftKey) accept(Math.max(0, chosen));
    else if (key === "Enter" && chosen >= 0) accept(chosen);
    else if (key === "Escape") close();
    else {
      if (["ArrowLeft", "ArrowRight", "Home", "End", "Enter"].includes(key)) close();
      return;
    }
    event.preventDefault();
  });
  find('[data-testid="download"]').addEventListener("click", run);
  find('[data-testid="drop"]').addEventListener("click", drop);

  // -- the panel -----------------------------------------------------------------------------------------------------

  let kept = null;
  const editor = {
    section,
    apply(changes, state) {
      if (changes.help && changes.help.n === asked) {
        help = changes.help;
        mark(help.marks);
        sign();
        open();
      }
      if (changes.said?.n === asked || (changes.said?.words && !asked)) {
        write(verdict, state.said.words ?? "");
        set(verdict, "data-refused", state.said.refused ? "" : null);
      }
    },
    // Another view of the same page was typed in, or the PLC has another program.
    follow(text) {
      if (area.value === text) return;
      area.value = text;
      remember("elsewhere");
      paint();
      tell();
    },
    // The PLC has another program: it is shown where nothing was typed; else what was typed stays.
    renew(fresh) {
      const mine = dirty() && area.value !== fresh.source;
      layout = fresh;
      source = fresh.source;
      if (!mine && area.value !== source) {
        editor.follow(source);
        mark([]);
      }
      if (mine) {
        write(verdict, "The PLC has got another program; what you typed is kept. Revert shows the program of the PLC.");
        set(verdict, "data-refused", null);
      }
      tell();
      if (kept) {
        [sheet.scrollTop, sheet.scrollLeft] = kept.scroll;
        area.setSelectionRange(...kept.selection);
        if (kept.focused) area.focus({ preventScroll: true });
      }
      kept = null;
    },
    rest: tell,
    close() {
      kept = { focused: document.activeElement === area, selection: [area.selectionStart, area.selectionEnd], scroll: [sheet.scrollTop, sheet.scrollLeft] };
      close();
    },
  };
  area.value = layout.draft ?? layout.source;
  now = present();
  mark([]);
  paint(true);
  tell();
  if (layout.draft !== null && layout.draft !== undefined) {
    write(verdict, "This was typed before and is not downloaded. Revert shows the program of the PLC.");
    setTimeout(ask);
  }
  view.editor = editor;
  return editor;
};
