"use strict";
// Motion that a button starts and stops.
const Motion = (() => {
  // Makes a button play a motion. `advance` gets the degrees since the last frame; `stop` is called at its end.
  function attach(button, degreesPerSecond, advance, stop = () => {}) {
    const isOn = () => button.getAttribute("aria-pressed") === "true";
    let before = null;
    function step(time) {
      if (!isOn()) {
        before = null;
        return;
      }
      if (before !== null) advance(degreesPerSecond * (time - before) / 1000);
      before = time;
      requestAnimationFrame(step);
    }
    button.addEventListener("click", () => {
      const on = !isOn();
      button.setAttribute("aria-pressed", on);
      button.textContent = on ? "Pause" : "Play";
      if (on) requestAnimationFrame(step);
      else stop();
    });
  }
  return { attach };
})();
