// Instruction list as tokens, a line at a time: for the editor panel and for JupyterLab's own editors.
// The kinds are those of the listing: op, step, device, name, number, keyword, comment; "" is what stands between.

const IL_HEADER = /^(?:(?:END_)?(?:PROGRAM|SUBROUTINE|INTERRUPT)|END_VAR|VAR_(?:GLOBAL|INPUT|OUTPUT|IN_OUT|TEMP))$/i;
const IL_DEVICE = /^(?:K\d+)?(?:X|Y|M|T|C|D|V|Z|SM|SD|LM)\d+(?:[A-Z]\d+)?$/i;
const IL_PARTS = /\/\/.*|\/\*|\(\*|[\s,]+|(?:(?!\/\/|\/\*|\(\*)[^\s,])+/g;

// What a line leaves open goes into the next: `comment` is the sign that ends a block, `table` tells a table of variables.
export const IL_BEGIN = { comment: "", table: false };

// -> { tokens: [[kind, text], ...], open }; the texts together are the line.
export function ilTokens(line, open = IL_BEGIN) {
  const tokens = [];
  let { comment, table } = open;
  let rest = line;
  const words = [];
  if (/^%%il\b/.test(line)) return { tokens: [["keyword", line]], open: IL_BEGIN };
  while (rest) {
    if (comment) {
      const end = rest.indexOf(comment);
      const cut = end < 0 ? rest.length : end + comment.length;
      tokens.push(["comment", rest.slice(0, cut)]);
      rest = rest.slice(cut);
      if (end >= 0) comment = "";
      continue;
    }
    IL_PARTS.lastIndex = 0;
    const part = IL_PARTS.exec(rest)[0];
    if (part === "/*" || part === "(*") {
      const close = part === "/*" ? "*/" : "*)";
      const end = rest.indexOf(close, 2);
      const cut = end < 0 ? rest.length : end + 2;
      tokens.push(["comment", rest.slice(0, cut)]);
      rest = rest.slice(cut);
      if (end < 0) comment = close;
      continue;
    }
    rest = rest.slice(part.length);
    if (part.startsWith("//")) tokens.push(["comment", part]);
    else if (/^[\s,]/.test(part)) tokens.push(["", part]);
    else {
      tokens.push([ilKind(part, words, table), part]);
      words.push(part);
    }
  }
  const head = (words[0] ?? "").toUpperCase();
  if (head.startsWith("VAR_") && words.length === 1) table = true;
  else if (head.startsWith("END_")) table = false;
  return { tokens, open: { comment, table } };
}

function ilKind(word, words, table) {
  const declares = table || (words.length && IL_HEADER.test(words[0]));
  if (!words.length) return IL_HEADER.test(word) ? "keyword" : table ? "name" : /^STL$/i.test(word) ? "step" : "op";
  if (declares && /^(?:AT|EVENT|:|BOOL|D?INT|D?WORD|REAL)$/i.test(word)) return "keyword";
  if (/^[+-]?(?:\d|\.\d)/.test(word)) return "number";
  if (/^S\d+$/i.test(word)) return "step";
  return IL_DEVICE.test(word) ? "device" : "name";
}
