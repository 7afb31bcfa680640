// The first script of a report in a frame of a page that has made it, in place of loader.js: its texts stand in it as
// they are. Where it says `data-plays`, the page runs the model again, and the machine moves at once unless the reader
// wants no motion. Not bundled.
const unpacked = async (id, page = document) => page.getElementById(id).textContent;
const model = async () => parent.model();
const plays =
  "plays" in document.currentScript.dataset && !matchMedia("(prefers-reduced-motion: reduce)").matches;
const hold = null;
