// Highlights instruction list in JupyterLab and Notebook: cells that begin with %%il, and .il files.
// JupyterLab loads this as a prebuilt extension, a module of its share scope; it is written by hand and needs no build.
(() => {
  const NAME = "ecsim-il";
  const MIME = "text/x-ecsim-il";
  const KINDS = ["op", "step", "device", "name", "number", "keyword", "comment"];
  const here = document.currentScript.src;
  const beside = (file) => new URL(file, here).href;

  let scope;
  const shared = async (module) => (await Object.values(scope[module])[0].get())();

  function style() {
    for (const file of ["tokens.css", "highlight.css"]) {
      const link = document.createElement("link");
      link.rel = "stylesheet";
      link.href = beside(file);
      document.head.append(link);
    }
  }

  // The language for CodeMirror: each line is taken apart at its begin by the same function that the editor panel uses.
  async function load() {
    const [{ ilTokens, IL_BEGIN }, language, { Tag }] = await Promise.all([import(beside("il.js")), shared("@codemirror/language"), shared("@lezer/highlight")]);
    const tokenTable = Object.fromEntries(KINDS.map((kind) => [kind, Tag.define()]));
    const parser = language.StreamLanguage.define({
      name: NAME,
      startState: () => ({ open: IL_BEGIN, queue: [] }),
      copyState: ({ open, queue }) => ({ open, queue: [...queue] }),
      token(stream, state) {
        if (stream.sol()) {
          const { tokens, open } = ilTokens(stream.string, state.open);
          Object.assign(state, { open, queue: tokens });
        }
        const [kind, text] = state.queue.shift() ?? ["", ""];
        if (text) stream.pos += text.length;
        else stream.skipToEnd();
        return kind || null;
      },
      languageData: { commentTokens: { line: "//", block: { open: "/*", close: "*/" } } },
      tokenTable,
    });
    const looks = language.HighlightStyle.define(KINDS.map((kind) => ({ tag: tokenTable[kind], class: `ec il-${kind}` })));
    return new language.LanguageSupport(parser, [language.syntaxHighlighting(looks)]);
  }

  // A cell is ours as long as it begins with %%il; the notebook says anew what its cells are whenever its kernel does.
  function follow(notebook, languages) {
    const followed = new WeakSet();
    const turn = () => new Promise((done) => setTimeout(done));
    const wanted = (cell) => {
      const ours = /^%%il\b/.test(cell.sharedModel.getSource());
      return ours ? MIME : cell.mimeType === MIME ? notebook.content.codeMimetype : cell.mimeType;
    };
    const mark = async (cell) => {
      if (cell.isDisposed || cell.type !== "code" || cell.mimeType === wanted(cell)) return;
      // The editor loads a language and shows it when it has come: the former one must not come after ours.
      await languages.getLanguage(cell.mimeType);
      await turn();
      if (!cell.isDisposed) cell.mimeType = wanted(cell);
    };
    const all = () => {
      for (const cell of notebook.content.model?.cells ?? []) {
        if (!followed.has(cell)) {
          followed.add(cell);
          cell.contentChanged.connect(() => mark(cell));
          cell.mimeTypeChanged.connect(() => turn().then(() => mark(cell)));
        }
        mark(cell);
      }
    };
    const attach = () => {
      notebook.content.model?.cells.changed.connect(all);
      all();
    };
    notebook.content.modelChanged.connect(attach);
    notebook.context.ready.then(() => setTimeout(attach));
  }

  async function extension() {
    const [{ IEditorLanguageRegistry }, { INotebookTracker }] = await Promise.all([shared("@jupyterlab/codemirror"), shared("@jupyterlab/notebook")]);
    return {
      id: "ecsim:instruction-list",
      description: "Highlights instruction list in %%il cells and .il files.",
      autoStart: true,
      requires: [IEditorLanguageRegistry],
      optional: [INotebookTracker],
      activate(app, languages, notebooks) {
        style();
        languages.addLanguage({ name: NAME, displayName: "PLC instruction list", mime: MIME, extensions: ["il"], load });
        app.docRegistry.addFileType({ name: NAME, displayName: "PLC program", extensions: [".il"], mimeTypes: [MIME], fileFormat: "text", contentType: "file" });
        notebooks?.forEach((notebook) => follow(notebook, languages));
        notebooks?.widgetAdded.connect((_, notebook) => follow(notebook, languages));
      },
    };
  }

  (window._JUPYTERLAB ??= {}).ecsim = {
    init(given) {
      scope = given;
    },
    async get() {
      const plugin = await extension();
      return () => ({ __esModule: true, default: plugin });
    },
  };
})();
