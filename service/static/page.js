// The newest shapes as pictures; each leads to what is similar to it (#/similar/<id>).

const SHOWN = 60;
const grid = document.getElementById("grid");
const title = document.getElementById("title");
const state = document.getElementById("state");
const keyForm = document.getElementById("key");

function headers() {
  const key = sessionStorage.getItem("key");
  return key ? { Authorization: `Bearer ${key}` } : {};
}

async function get(path) {
  const answer = await fetch(path, { headers: headers() });
  keyForm.hidden = answer.status !== 401;
  if (!answer.ok) {
    const problem = await answer.json().catch(() => ({ detail: answer.statusText }));
    throw new Error(problem.detail);
  }
  return answer;
}

const read = async (path) => (await get(path)).json();

async function showPicture(image, path) {
  if (!sessionStorage.getItem("key")) {
    image.src = path;
    return;
  }
  const picture = await (await get(path)).blob(); // an <img> cannot send a key itself
  image.onload = () => URL.revokeObjectURL(image.src);
  image.src = URL.createObjectURL(picture);
}

function element(name, text) {
  const made = document.createElement(name);
  if (text !== undefined) made.textContent = text;
  return made;
}

function card(shape, note) {
  const link = element("a");
  link.href = `#/similar/${encodeURIComponent(shape.id)}`;
  if (shape.status === "ready") {
    const image = element("img");
    image.alt = "";
    image.loading = "lazy";
    image.width = image.height = 256;
    showPicture(image, `/v1/shapes/${encodeURIComponent(shape.id)}/thumbnail.png`).catch(() => {});
    link.append(image);
  } else {
    const blank = element("span", shape.status);
    blank.className = "blank";
    link.append(blank);
  }
  link.append(element("span", shape.name), element("small", note));
  const item = element("li");
  item.append(link);
  return item;
}

function noteOf(shape) {
  if (shape.error) return shape.error.code;
  return shape.mesh ? `${shape.mesh.faces.toLocaleString()} faces` : shape.status;
}

async function showNewest() {
  const page = await read(`/v1/shapes?limit=${SHOWN}`);
  title.textContent = "Newest shapes";
  const more = page.next_cursor ? `the newest ${page.items.length}` : `${page.items.length}`;
  state.textContent = page.items.length
    ? `${more} shapes; choose one to see what is similar`
    : "The library is empty. Add a mesh: curl -F files=@amphora.ply " + location.origin + "/v1/shapes";
  grid.replaceChildren(...page.items.map((shape) => card(shape, noteOf(shape))));
}

async function showSimilar(id) {
  const path = `/v1/shapes/${encodeURIComponent(id)}`;
  const shape = await read(path);
  title.textContent = `Similar to ${shape.name}`;
  if (shape.status !== "ready") {
    state.textContent = shape.error ? `${shape.error.code}: ${shape.error.detail}` : `The shape is ${shape.status}.`;
    grid.replaceChildren(card(shape, "this shape"));
    return;
  }
  const answer = await read(`${path}/similar?limit=24`);
  state.textContent = `${answer.results.length} results by ${answer.method} in ${Math.round(answer.took_ms)} ms`;
  const results = answer.results.map((hit) => card(hit.shape, `${hit.rank}. distance ${hit.distance.toFixed(3)}`));
  grid.replaceChildren(card(shape, "this shape"), ...results);
}

async function show() {
  const match = location.hash.match(/^#\/similar\/(.+)$/);
  try {
    await (match ? showSimilar(decodeURIComponent(match[1])) : showNewest());
  } catch (error) {
    grid.replaceChildren();
    state.textContent = error.message;
  }
}

keyForm.addEventListener("submit", (event) => {
  event.preventDefault();
  sessionStorage.setItem("key", document.getElementById("secret").value);
  show();
});
window.addEventListener("hashchange", show);
show();
