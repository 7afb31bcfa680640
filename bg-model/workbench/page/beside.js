// The first script of a report in a frame of a page that has made it, in place of loader.js: its texts stand in it as
// they are, the page runs the model, and the machine moves at once unless the reader wants no motion. Not bundled.
const unpacked = async (id) => document.getElementById(id).textContent;
const model = async () => parent.model();
const plays = !matchMedia("(prefers-reduced-motion: reduce)").matches;
const hold = null;
