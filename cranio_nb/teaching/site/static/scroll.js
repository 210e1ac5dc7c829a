// What is wider than the page is scrolled by arrow keys once it has the focus; what is not is no stop on the way.
(function () {
  "use strict";
  function mark() {
    for (const box of document.querySelectorAll("pre, .table-wrapper, math[display='block']")) {
      if (box.scrollWidth > box.clientWidth) box.tabIndex = 0;
      else box.removeAttribute("tabindex");
    }
  }
  window.addEventListener("load", mark);
  window.addEventListener("resize", mark);
})();
