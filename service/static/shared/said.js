// What those who listen to the page hear when something changes.

const place = document.getElementById("said");

export function say(text) {
  place.textContent = text;
}
