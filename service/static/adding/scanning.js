// Which other files a mesh names, without reading it whole into memory: an OBJ may have half a gigabyte.

const PIECE = 8 * 2 ** 20; // bytes read at a time
const LONGEST_LINE = 2 ** 16; // bytes of a line that names something
const HEADER = 2 ** 20; // bytes of a PLY's header at most

/** Text as UTF-8, or as Latin-1 where it is not: only names can differ. */
export function decoded(bytes) {
  try {
    return new TextDecoder("utf-8", { fatal: true }).decode(bytes);
  } catch {
    return new TextDecoder("latin1").decode(bytes);
  }
}

/**
 * Find what an OBJ file names.
 *
 * The line `mtllib` mostly stands at the top, but may stand anywhere: programs that join objects write one before each.
 * The lines `usemtl`, which say whose images the mesh needs of a shared material file, are all over the file. So it is
 * read to its end, in pieces, and only where material files are there to be found: some 4 s for half a gigabyte.
 *
 * @param {Blob} file
 * @returns {Promise<{libraries: string[], materials: Set<string>}>} what stands after each mtllib, and each usemtl
 */
export async function scanObj(file) {
  const found = { libraries: [], materials: new Set() };
  for (let start = 0; start < file.size; start += PIECE) {
    // each piece takes a line more: one that begins in it is read whole, one that began before it is seen there
    const end = Math.min(start + PIECE, file.size);
    const from = Math.max(start - LONGEST_LINE, 0);
    const bytes = new Uint8Array(await file.slice(from, end + LONGEST_LINE).arrayBuffer());
    collect(bytes, start - from, end - from, found);
  }
  return found;
}

/** Collect the keywords that begin between two places of a piece. */
function collect(bytes, first, last, found) {
  const text = new TextDecoder("latin1").decode(bytes); // one character a byte
  for (let place = text.indexOf("mtl", first); place >= 0; place = text.indexOf("mtl", place + 3)) {
    const library = text.startsWith("lib", place + 3);
    const start = library ? place : place - 3;
    if (start >= last) return;
    if (start < first || !beginsLine(text, start) || !(library || text.startsWith("use", start))) continue;
    const after = start + 6;
    const length = text.slice(after, after + LONGEST_LINE).search(/[\r\n]|$/);
    const rest = decoded(bytes.subarray(after, after + length));
    if (rest && !/^\s/.test(rest)) continue;
    if (library) found.libraries.push(rest.trim());
    else found.materials.add(rest.trim());
  }
}

function beginsLine(text, place) {
  while (place > 0 && " \t".includes(text[place - 1])) place -= 1;
  return place === 0 || "\r\n".includes(text[place - 1]) || text.slice(0, place) === "ï»¿"; // a byte order mark
}

/**
 * Find the images that the header of a PLY file names.
 *
 * @param {Blob} file
 * @returns {Promise<string[]>}
 */
export async function scanPly(file) {
  const text = decoded(await file.slice(0, HEADER).arrayBuffer());
  const header = text.slice(0, Math.max(text.search(/[\r\n]end_header/), 0));
  return [...header.matchAll(/^\s*comment[ \t]+TextureFile[ \t]+(.+)$/gm)].map((line) => line[1].trim());
}
