// Panels without a kernel: every setting was drawn ahead, and a control only chooses which picture is shown. It answers
// the panel's own front as a kernel's widget would. A plain script: pages opened from disk load no modules.
(function () {
  "use strict";

  const DRAG = 14; // px of a drag for one stop, at least

  // Places of values on their axes: the very stop, or the nearest one.
  function placesOf(axes, values) {
    return axes.map(({ name, stops }) => {
      const exact = stops.indexOf(values[name]);
      if (exact >= 0 || typeof values[name] !== "number") return Math.max(exact, 0);
      let best = 0;
      stops.forEach((stop, i) => {
        if (Math.abs(stop - values[name]) < Math.abs(stops[best] - values[name])) best = i;
      });
      return best;
    });
  }

  class Ahead {
    constructor(data) {
      this.data = data;
      this.heard = new Map();
      this.state = { ...data.panel, drawn: 1 };
      this.go(placesOf(data.panel.controls, data.panel.values));
    }

    index(places) {
      return this.data.panel.controls.reduce((sum, { stops }, i) => sum * stops.length + places[i], 0);
    }

    address(places) {
      return `${this.data.folder}/${this.data.files[this.data.pictures[this.index(places)]]}`;
    }

    // what stands at its end stays at its end where the picture moves that end, and nothing stands beyond it
    settled(asked) {
      const places = [...asked];
      const { controls } = this.data.panel;
      for (const [i, top] of this.places ? this.data.tops[this.index(this.places)] : []) {
        if (places[i] === top) places[i] = controls[i].stops.length - 1;
      }
      for (const [i, top] of this.data.tops[this.index(places)]) places[i] = Math.min(places[i], top);
      return places;
    }

    go(asked) {
      const { controls } = this.data.panel;
      const places = this.settled(asked);
      const at = this.index(places);
      this.places = places;
      this.state.limits = Object.fromEntries(this.data.tops[at].map(([i, , end]) => [controls[i].name, end]));
      this.state.values = Object.fromEntries(controls.map(({ name, stops }, i) => [name, stops[places[i]]]));
      this.state.off = this.data.off[at].map((i) => controls[i].name);
      this.state.caption = this.data.lines[at];
      this.state.picture = this.address(places);
    }

    // what a widget of the kernel answers
    get(name) {
      return this.state[name];
    }
    set(name, value) {
      this.state[name] = value;
    }
    on(names, act) {
      for (const name of names.split(" ")) this.heard.set(name, [...(this.heard.get(name) ?? []), act]);
    }
    off(names, act) {
      for (const name of names.split(" ")) this.heard.set(name, this.heard.get(name).filter((other) => other !== act));
    }
    tell(name) {
      for (const act of this.heard.get(`change:${name}`) ?? []) act();
    }
    save_changes() {
      this.go(placesOf(this.data.panel.controls, this.state.values));
      for (const name of ["values", "picture", "caption"]) this.tell(name);
      const picture = new Image();
      picture.onload = picture.onerror = () => {
        this.state.drawn += 1;
        this.tell("drawn");
      };
      picture.src = this.state.picture;
      this.fetchNear();
    }

    // the neighbours' pictures, so that the next one is there at once
    fetchNear() {
      this.places.forEach((place, i) => {
        for (const step of [-1, 1, 2]) {
          const near = [...this.places];
          near[i] = this.within(i, place + step);
          new Image().src = this.address(near);
        }
      });
    }

    // a place on an axis, kept within its ends, or taken round them
    within(i, place) {
      const { stops, cyclic } = this.data.panel.controls[i];
      const n = stops.length;
      return cyclic ? ((place % n) + n) % n : Math.min(Math.max(place, 0), n - 1);
    }

    moveTo(places) {
      if (places.join() === this.places.join()) return;
      const { controls } = this.data.panel;
      this.state.values = Object.fromEntries(controls.map(({ name, stops }, i) => [name, stops[places[i]]]));
      this.save_changes();
    }
  }

  // Dragging the picture sideways moves the first slider that has an effect; what turns is dragged up and down as well.
  function drag(model, picture) {
    const controls = model.get("controls");
    const sliders = controls.map((_, i) => i).filter((i) => controls[i].kind === "slider");
    if (!sliders.length) return;
    const turns = controls[sliders[0]].cyclic;
    picture.classList.add(turns ? "turns" : "across");
    let from = null;
    picture.addEventListener("pointerdown", (event) => {
      const across = sliders.find((i) => !model.get("off").includes(controls[i].name));
      if (event.button || across === undefined) return;
      from = { x: event.clientX, y: event.clientY, places: model.places, across };
      picture.setPointerCapture(event.pointerId);
    });
    picture.addEventListener("pointermove", (event) => {
      if (!from) return;
      const { across } = from;
      const step = turns ? DRAG : Math.max(DRAG, picture.clientWidth / controls[across].stops.length);
      const to = [...from.places];
      // a scene follows the hand, so its viewer goes the other way round
      to[across] = model.within(across, to[across] + (turns ? -1 : 1) * Math.round((event.clientX - from.x) / step));
      if (turns && sliders.length > 1) {
        const along = sliders[1];
        to[along] = model.within(along, to[along] + Math.round((event.clientY - from.y) / (4 * DRAG)));
      }
      model.moveTo(to);
    });
    for (const kind of ["pointerup", "pointercancel"]) {
      picture.addEventListener(kind, () => {
        from = null;
      });
    }
  }

  document.addEventListener("DOMContentLoaded", () => {
    for (const place of document.querySelectorAll(".cranio-ahead")) {
      const model = new Ahead(JSON.parse(place.querySelector("script").textContent));
      place.querySelector("figure").remove(); // stood there for pages without scripts
      window.cranioPanel({ model, el: place });
      const picture = place.querySelector("img");
      picture.draggable = false;
      drag(model, picture);
      for (const kind of ["pointerenter", "focusin"]) {
        place.addEventListener(kind, () => model.fetchNear(), { once: true });
      }
    }
  });
})();
