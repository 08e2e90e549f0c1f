// The keyboard of the 3D view: arrows turn, + and − zoom, Page Up and Page Down go through the results.

const KEYS = {
  ArrowLeft: (viewer) => viewer.stage?.turn(-1, 0),
  ArrowRight: (viewer) => viewer.stage?.turn(1, 0),
  ArrowUp: (viewer) => viewer.stage?.turn(0, -1),
  ArrowDown: (viewer) => viewer.stage?.turn(0, 1),
  "+": (viewer) => viewer.stage?.zoom(1),
  "=": (viewer) => viewer.stage?.zoom(1), // + without Shift on many keyboards
  "-": (viewer) => viewer.stage?.zoom(-1),
  PageUp: (viewer) => viewer.go(viewer.place - 1),
  PageDown: (viewer) => viewer.go(viewer.place + 1),
};

/** Do what a key asks for. */
export function pressed(event, viewer) {
  const act = KEYS[event.key];
  if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  act(viewer);
}
