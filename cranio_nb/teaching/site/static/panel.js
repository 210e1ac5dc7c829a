// Panels without a kernel: every setting was drawn ahead; a control only chooses which picture is shown.
// Plain script, for pages opened from disk: browsers load no modules and fetch nothing there.
(function () {
  "use strict";
  var PAUSE = 350; // ms between two pictures of a film
  var STEP = 14; // px of a drag for one stop, at least

  function Panel(figure) {
    var self = this;
    this.figure = figure;
    this.data = JSON.parse(figure.querySelector("script[type='application/json']").textContent);
    this.image = figure.querySelector("img");
    this.caption = figure.querySelector("figcaption");
    this.places = this.data.axes.map(function (axis) { return axis.start; });
    this.inputs = this.data.axes.map(function (_, i) { return figure.querySelector("[data-axis='" + i + "']"); });
    this.playing = null;
    this.inputs.forEach(function (input, i) {
      input.addEventListener("input", function () { self.stop(); self.move(i, self.placeOf(input)); });
    });
    figure.querySelectorAll("[data-preset]").forEach(function (button) {
      button.addEventListener("click", function () { self.stop(); self.go(JSON.parse(button.dataset.preset)); });
    });
    figure.querySelectorAll("[data-play]").forEach(function (button) {
      button.addEventListener("click", function () { self.toggle(button, Number(button.dataset.play)); });
    });
    // neighbours are loaded when a hand comes near, not before
    ["pointerenter", "focusin"].forEach(function (kind) {
      figure.addEventListener(kind, function () { self.prefetch(); }, { once: true });
    });
    this.drag();
    figure.querySelector("form").hidden = false;
    this.show();
  }

  Panel.prototype.placeOf = function (input) {
    if (input.type === "checkbox") { return input.checked ? 1 : 0; }
    return input.tagName === "SELECT" ? input.selectedIndex : Number(input.value);
  };

  Panel.prototype.index = function (places) {
    return this.data.axes.reduce(function (sum, axis, i) { return sum * axis.texts.length + places[i]; }, 0);
  };

  Panel.prototype.address = function (places) {
    return this.data.folder + "/" + this.data.files[this.data.pictures[this.index(places)]];
  };

  // a place on an axis, kept within its ends, or taken round them
  Panel.prototype.within = function (i, place) {
    var axis = this.data.axes[i], n = axis.texts.length;
    return axis.cyclic ? ((place % n) + n) % n : Math.min(Math.max(place, 0), n - 1);
  };

  Panel.prototype.move = function (i, place) {
    var to = this.places.slice();
    to[i] = this.within(i, place);
    this.go(to);
  };

  Panel.prototype.go = function (places) {
    this.places = places;
    this.show();
    this.prefetch();
  };

  Panel.prototype.show = function () {
    var at = this.index(this.places), line = this.data.lines[at], off = this.data.off[at], self = this;
    this.image.src = this.address(this.places);
    this.image.alt = this.data.alt + " " + line;
    this.caption.textContent = line;
    this.inputs.forEach(function (input, i) {
      var place = self.places[i], text = self.data.axes[i].texts[place];
      input.disabled = off.indexOf(i) >= 0;
      if (input.type === "checkbox") { input.checked = place === 1; }
      else if (input.tagName === "SELECT") { input.selectedIndex = place; }
      else {
        input.value = place;
        input.setAttribute("aria-valuetext", text);
        input.parentNode.querySelector("output").textContent = text;
      }
    });
  };

  Panel.prototype.prefetch = function () {
    var self = this;
    this.places.forEach(function (place, i) {
      [-1, 1, 2].forEach(function (step) {
        var near = self.places.slice();
        near[i] = self.within(i, place + step);
        new Image().src = self.address(near);
      });
    });
  };

  Panel.prototype.toggle = function (button, i) {
    if (this.playing) { this.stop(); return; }
    var last = this.data.axes[i].texts.length - 1, self = this;
    this.playing = button;
    button.textContent = "Pause";
    this.caption.setAttribute("aria-live", "off"); // a film is not read aloud
    if (this.places[i] === last) { this.move(i, 0); }
    (function next() {
      self.timer = setTimeout(function () {
        self.move(i, self.places[i] + 1);
        if (self.places[i] === last) { self.stop(); } else { next(); }
      }, PAUSE);
    })();
  };

  Panel.prototype.stop = function () {
    if (!this.playing) { return; }
    clearTimeout(this.timer);
    this.playing.textContent = "Play";
    this.playing = null;
    this.caption.setAttribute("aria-live", "polite");
  };

  // dragging the picture sideways moves the first slider; what turns is dragged up and down as well
  Panel.prototype.drag = function () {
    var self = this, image = this.image, from = null;
    var sliders = this.inputs.map(function (_, i) { return i; })
      .filter(function (i) { return self.inputs[i].type === "range"; });
    if (!sliders.length) { return; }
    var across = sliders[0], along = this.data.axes[across].cyclic ? sliders[1] : undefined;
    var sign = this.data.axes[across].cyclic ? -1 : 1; // the scene follows the hand, so the viewer goes the other way
    image.classList.add(along === undefined ? "cranio-across" : "cranio-turns");
    image.addEventListener("pointerdown", function (event) {
      if (event.button) { return; }
      self.stop();
      from = { x: event.clientX, y: event.clientY, places: self.places.slice() };
      image.setPointerCapture(event.pointerId);
    });
    image.addEventListener("pointermove", function (event) {
      if (!from) { return; }
      var n = self.data.axes[across].texts.length, to = self.places.slice();
      var step = self.data.axes[across].cyclic ? STEP : Math.max(STEP, image.clientWidth / n);
      to[across] = self.within(across, from.places[across] + sign * Math.round((event.clientX - from.x) / step));
      if (along !== undefined) {
        to[along] = self.within(along, from.places[along] + Math.round((event.clientY - from.y) / (4 * STEP)));
      }
      if (self.inputs[across].disabled) { return; }
      if (to.join() !== self.places.join()) { self.go(to); }
    });
    ["pointerup", "pointercancel"].forEach(function (kind) {
      image.addEventListener(kind, function () { from = null; });
    });
  };

  document.addEventListener("DOMContentLoaded", function () {
    document.querySelectorAll(".cranio-panel").forEach(function (figure) { new Panel(figure); });
  });
})();
