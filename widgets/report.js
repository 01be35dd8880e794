// The grader's report: its HTML comes ready made; a click on a button in it is one message, and words come back for the hint.

export default {
  render({ model, el }) {
    const place = document.createElement("div");
    place.className = "ec-root";
    el.append(place);
    const draw = () => { place.innerHTML = model.get("html"); say(); };
    const say = () => {
      const { words = "", button = "", open = false } = model.get("help");
      const box = place.querySelector("[data-place=hint]");
      if (!box) return;
      box.querySelector("p").textContent = words;
      const key = box.querySelector("button");
      key.textContent = button;
      key.disabled = !open;
    };
    const click = (event) => {
      const button = event.target.closest("button[data-act]");
      if (button && !button.disabled) model.send({ act: button.dataset.act, rule: button.dataset.rule ?? "" });
    };
    place.addEventListener("click", click);
    model.on("change:html", draw);
    model.on("change:help", say);
    draw();
    return () => {
      place.removeEventListener("click", click);
      model.off("change:html", draw);
      model.off("change:help", say);
    };
  },
};
