// A panel's picture with its controls beside it. `model` is the kernel's widget, or anything that answers get, set,
// on, off, save_changes and send as it does. Native elements only: they have names, and obey mouse, keys and touch.

const PACES = [
  ["slow at first", null],
  ["2 steps a second", 500],
  ["5 steps a second", 200],
  ["20 steps a second", 50],
];
const FIRST_PACE = 150; // ms between two pictures where the steps in between grow
const GROWTH = 12; // steps after which a picture is skipped for the first time

function make(tag, properties = {}, ...children) {
  const { aria = {}, ...own } = properties;
  const node = Object.assign(document.createElement(tag), own);
  for (const [name, value] of Object.entries(aria)) node.setAttribute(`aria-${name}`, value);
  node.append(...children);
  return node;
}

const titleOf = (control) => (control.unit ? `${control.label} (${control.unit})` : control.label);

function nearest(stops, value) {
  let best = 0;
  stops.forEach((stop, i) => {
    if (Math.abs(stop - value) < Math.abs(stops[best] - value)) best = i;
  });
  return best;
}

// Each row: the nodes to place, and how they show a value, the highest stop within reach, and having no effect.

function sliderRow(control, model, move) {
  const { stops } = control;
  const title = titleOf(control);
  const range = make("input", { type: "range", min: 0, step: 1, aria: { label: title } });
  const box = make("input", { type: "text", inputMode: "decimal", aria: { label: `${title}, typed` } });
  const heard = control.slow ? "change" : "input";
  let end; // the highest value within reach, where the picture moves it
  const text = () => String(end !== undefined && range.value === range.max ? end : stops[range.value]);
  range.addEventListener("input", () => {
    box.value = text();
    range.setAttribute("aria-valuetext", `${text()} ${control.unit}`.trim());
  });
  range.addEventListener(heard, () => move({ [control.name]: stops[range.value] }));
  box.addEventListener("change", () => {
    const value = Number(box.value.replace(",", "."));
    if (box.value.trim() && Number.isFinite(value)) range.value = value >= end ? range.max : nearest(stops, value);
    range.dispatchEvent(new Event("input"));
    if (heard === "change") range.dispatchEvent(new Event("change"));
  });
  const show = (value, top, off) => {
    end = top;
    range.max = top === undefined ? stops.length - 1 : stops.findIndex((stop) => stop >= top);
    range.disabled = box.disabled = off;
    if (range.matches(":active")) return; // a hand holds it
    range.value = nearest(stops, value);
    if (document.activeElement !== box) box.value = off ? "" : text(); // what has no effect says nothing
    range.setAttribute("aria-valuetext", off ? "no effect" : `${text()} ${control.unit}`.trim());
  };
  const nodes = [make("div", { className: "row" }, make("span", {}, title), box), range];
  if (control.player) nodes.push(player(control, model, range, move));
  return { nodes, show };
}

function choiceRow(control, model, move) {
  const options = control.stops.map((stop) => make("option", { value: stop }, stop));
  const select = make("select", {}, ...options);
  select.addEventListener("change", () => move({ [control.name]: select.value }));
  const show = (value, top, off) => Object.assign(select, { value, disabled: off });
  return { nodes: [make("label", {}, make("span", {}, titleOf(control)), select)], show };
}

function switchRow(control, model, move) {
  const box = make("input", { type: "checkbox" });
  box.addEventListener("change", () => move({ [control.name]: box.checked }));
  const show = (value, top, off) => Object.assign(box, { checked: value, disabled: off });
  return { nodes: [make("label", { className: "switch" }, box, titleOf(control))], show };
}

const ROWS = { slider: sliderRow, choice: choiceRow, switch: switchRow };

// Play and single steps. The next picture is asked for when the last one has come, and its time is up.

function player(control, model, range, move) {
  const button = (text, label) => make("button", { type: "button", title: label, aria: { label } }, text);
  const back = button("\u2212 1", "\u2212 1: one step back");
  const play = button("\u25B6 Play", "play");
  const on = button("+ 1", "+ 1: one step on");
  const pace = make("select", { title: "pace", aria: { label: "pace" } });
  pace.append(...PACES.map(([name], i) => make("option", { value: i }, name)));
  let timer = null;
  let due = false;
  const go = (to) => {
    range.value = to;
    range.dispatchEvent(new Event("input"));
    if (control.slow) range.dispatchEvent(new Event("change"));
  };
  const stop = () => {
    clearTimeout(timer);
    timer = null;
    play.textContent = "\u25B6 Play";
    play.setAttribute("aria-label", (play.title = "play"));
  };
  const wait = () => {
    due = false;
    timer = setTimeout(() => {
      due = true;
      if (model.get("drawn") >= asked) next();
    }, PACES[pace.value][1] ?? FIRST_PACE);
  };
  let asked = 0;
  const next = () => {
    const at = Number(range.value);
    const top = Number(range.max);
    if (at >= top) return stop();
    const grown = PACES[pace.value][1] === null ? Math.floor(at / GROWTH) : 0;
    asked = model.get("drawn") + 1;
    wait();
    go(Math.min(at + 1 + grown, top));
  };
  model.on("change:drawn", () => {
    if (timer !== null && due && model.get("drawn") >= asked) next();
  });
  play.addEventListener("click", () => {
    if (timer !== null) return stop();
    play.textContent = "\u275A\u275A Pause";
    play.setAttribute("aria-label", (play.title = "pause"));
    if (Number(range.value) >= Number(range.max)) {
      asked = model.get("drawn") + 1;
      wait();
      go(0);
    } else next();
  });
  back.addEventListener("click", () => go(Math.max(Number(range.value) - 1, 0)));
  on.addEventListener("click", () => go(Number(range.value) + 1));
  return make("div", { className: "player" }, back, play, on, pace);
}

function render({ model, el }) {
  const caption = make("div");
  caption.setAttribute("role", "status");
  const picture = make("img", { alt: model.get("alt"), width: model.get("width"), height: model.get("height") });
  const move = (values) => {
    if (model.get("slow")) caption.textContent = "Working \u2026";
    model.set("values", { ...model.get("values"), ...values });
    model.save_changes();
  };
  const controls = model.get("controls");
  const rows = new Map(controls.map((c) => [c.name, ROWS[c.kind](c, model, move)]));
  const nodes = (expert) => controls.filter((c) => c.expert === expert).map((c) => rows.get(c.name).nodes);
  const set = (children) => children.map((some) => make("div", { className: "control" }, ...some));

  const push = (text, act) => {
    const button = make("button", { type: "button" }, text);
    button.addEventListener("click", act);
    return button;
  };
  const presets = Object.entries(model.get("presets")).map(([name, values]) => push(name, () => move(values)));
  const actions = model.get("actions").map((name) => push(name, () => model.send({ action: name })));
  const side = make("div", { className: "controls" });
  side.setAttribute("role", "group");
  side.setAttribute("aria-label", "controls");
  side.append(make("div", { className: "presets" }, ...presets), ...set(nodes(false)));
  if (nodes(true).length) {
    side.append(make("details", {}, make("summary", {}, "more settings"), ...set(nodes(true))));
  }
  if (actions.length) side.append(make("div", { className: "presets" }, ...actions));
  const root = make("div", { className: "cranio-panel" }, make("figure", {}, picture, make("figcaption", {}, caption)), side);
  root.addEventListener("keydown", (event) => {
    if (!event.ctrlKey && !event.metaKey && !event.altKey) event.stopPropagation(); // else JupyterLab takes the arrows
  });
  el.append(root);

  let url = null;
  const drawn = () => {
    const sent = model.get("picture");
    URL.revokeObjectURL(url);
    url = typeof sent === "string" ? null : URL.createObjectURL(new Blob([sent], { type: "image/jpeg" }));
    picture.src = url ?? sent; // a page without a kernel sends the picture's address
  };
  const said = () => {
    caption.textContent = model.get("caption");
    picture.alt = `${model.get("alt")} ${model.get("caption")}`;
  };
  const shown = () => {
    const [values, limits, off] = ["values", "limits", "off"].map((name) => model.get(name));
    for (const [name, row] of rows) row.show(values[name], limits[name], off.includes(name));
  };
  const watched = [
    ["change:picture", drawn],
    ["change:drawn", said],
    ["change:caption", said],
    ["change:values change:limits change:off", shown],
  ];
  for (const [names, act] of watched) model.on(names, act);
  drawn();
  said();
  shown();
  return () => {
    for (const [names, act] of watched) model.off(names, act);
    URL.revokeObjectURL(url);
  };
}

export default { render };
