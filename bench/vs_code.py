"""VS Code's own widget manager in a page, with a real kernel behind it: what its notebooks show panels with, without the editor around it.

    python bench/vs_code.py      fetch it with npm and build the page, into build/vs_code; needs Node.js

VS Code's Jupyter extension comes from an extension marketplace alone, but the part of it that shows widgets is an npm package of its own.
`tests/browser/test_vs_code.py` drives every panel in it; without build/vs_code it is skipped.
"""

import json
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "build" / "vs_code"
SITE = FOLDER / "site"
# The widget manager's package names all of JupyterLab as what it was built from; its bundle needs none of it, so it is taken as it is packed.
MANAGER = "@vscode/jupyter-ipywidgets8@1.0.9"
PACKAGES = {"requirejs": "2.3.8", "esbuild": "0.28.2", "@jupyterlab/services": "7.4.10"}
KERNELS = """
import { KernelManager, ServerConnection } from '@jupyterlab/services';

window.openKernel = async (token) => {
  const baseUrl = `${location.origin}/`;
  const serverSettings = ServerConnection.makeSettings({ baseUrl, wsUrl: baseUrl.replace('http', 'ws'), token, appendToken: true });
  const kernel = await new KernelManager({ serverSettings }).startNew({ name: 'python3' });
  await kernel.info;
  return kernel;
};
"""
# Outputs stand in one page; the ground under a widget is white in every theme, as VS Code has it.
PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Outputs</title>
<style>
body { margin: 0; background: var(--vscode-editor-background); color: var(--vscode-editor-foreground); font-family: var(--vscode-font-family); }
.cell-output-ipywidget-background { background: white !important; padding: 8px; }
</style></head>
<body><div id="outputs"></div>
<script src="/static/require.js"></script>
<script src="/static/kernels.js"></script>
<script type="module">
import { activate } from '/static/ipywidgets.js';
activate();
window.vscIPyWidgets8.load();
requirejs.config({ paths: { anywidget: '/static/anywidget/index' } });
const outputs = document.getElementById('outputs');
const scripts = {
  widgetsRegisteredInRequireJs: new Set(['anywidget']),
  loadWidgetScript: async (name) => { throw new Error(`${name} is not there`); },
  successHandler() {},
  errorHandler: (name, module, version, error) => window.errors.push(`${name} of ${module} ${version}: ${error}`),
};
window.errors = [];
window.begin = async (token) => {
  window.kernel = await window.openKernel(token);
  window.manager = new window.vscIPyWidgets.WidgetManager(window.kernel, outputs, scripts, () => {});
};
window.run = async (code) => {
  const shown = [];
  let text = '';
  const future = window.kernel.requestExecute({ code });
  future.onIOPub = ({ header, content }) => {
    if (header.msg_type === 'stream') text += content.text;
    if (header.msg_type === 'error') window.errors.push(`${content.ename}: ${content.evalue}`);
    const view = content.data?.['application/vnd.jupyter.widget-view+json'];
    if (view) shown.push(view.model_id);
  };
  await future.done;
  for (const id of shown) {
    const node = document.createElement('div');
    node.className = 'cell-output-ipywidget-background';
    outputs.append(node);
    await window.manager.display_view(null, await window.manager.create_view(await window.manager.get_model(id)), { node });
  }
  return text.trim();
};
window.ready = true;
</script></body></html>
"""


def fetch() -> None:
    """Fetch the packages and write the site; what was there goes when the new one is whole."""
    npm = shutil.which("npm")
    if npm is None:
        raise SystemExit("npm is not there: install Node.js")
    new = FOLDER.with_name("vs_code.new")
    shutil.rmtree(new, ignore_errors=True)
    site = new / "site"
    site.mkdir(parents=True)
    (new / "package.json").write_text(json.dumps({"private": True, "dependencies": PACKAGES}), encoding="utf-8")
    (new / "kernels.js").write_text(KERNELS, encoding="utf-8")
    (site / "host.html").write_text(PAGE, encoding="utf-8")
    subprocess.run([npm, "install", "--silent", "--no-audit", "--no-fund"], cwd=new, check=True)
    packed = subprocess.run([npm, "pack", "--silent", MANAGER], cwd=new, check=True, capture_output=True, text=True).stdout.split()[-1]
    shutil.unpack_archive(new / packed, new / "manager")
    shutil.copy(new / "manager" / "package" / "dist" / "ipywidgets.js", site)
    shutil.copy(new / "node_modules" / "requirejs" / "require.js", site)
    shutil.copytree(Path(sys.prefix) / "share" / "jupyter" / "nbextensions" / "anywidget", site / "anywidget")
    bundle = ["exec", "--", "esbuild", "kernels.js", "--bundle", "--format=iife", "--log-level=warning", "--outfile=site/kernels.js"]
    subprocess.run([npm, *bundle], cwd=new, check=True)
    shutil.rmtree(FOLDER, ignore_errors=True)
    new.rename(FOLDER)
    print(f"{SITE.relative_to(ROOT)}: {sum(path.stat().st_size for path in SITE.rglob('*') if path.is_file()) / 1e6:.1f} MB")


if __name__ == "__main__":
    fetch()
