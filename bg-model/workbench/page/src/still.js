// A picture of the machine alone, for documents: with `#still=T` in the address the page shows nothing but the machine
// at T s, with no background. A browser that takes a picture waits for it: the loader holds it.

/* global hold */

export async function still(start) {
  document.documentElement.classList.add("still");
  const { clock, view } = await start();
  clock.seek(Number(location.hash.split("=")[1]));
  view?.renderer.render(view.scene, view.camera);
  hold.contentDocument.close();
}
