// The machine's picture, moved by its plant.

panels.machine = (place, layout, page) => {
  const { section, body, sub } = frame(place, { title: layout.title, sub: "machine", key: "machine" });
  section.classList.add("mach");
  body.classList.add("scroll");
  const drawing = new Drawing(body, layout.svg);
  return {
    apply(changes) {
      drawing.apply(changes);
    },
    run(run) {
      write(sub, run.plant === false ? "machine, disconnected: the switches are yours" : "machine");
      set(section, "data-off", run.plant === false ? "" : null);
    },
  };
};
