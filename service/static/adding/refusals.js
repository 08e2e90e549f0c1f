// Refusals in words: what the reason is called, and what somebody can do. The service's own detail stands between.

import { kindOf } from "./kinds.js";

const EXPORT_AGAIN = "Export the mesh again and add it anew.";
const SIMPLIFY = "Simplify the mesh, then add it again.";
const TELL = "Try again; if it happens again, tell whoever runs the service.";

/** What can be done in a row: `file`, `untextured` and `again` are its buttons. */
const REFUSALS = {
  empty: ["The file is empty", EXPORT_AGAIN],
  no_mesh: ["There is no mesh in it", "Add a .ply or an .obj, or a zip that holds one."],
  several_meshes: [
    "There is more than one mesh in it",
    "Unpack it and add its folder: each mesh becomes a shape of its own.",
  ],
  not_ply: ["This is no PLY file", "Export it as PLY, or give the file the ending of what it is."],
  not_obj: ["This is no OBJ file", "Export it as OBJ, or give the file the ending of what it is."],
  not_utf8: ["The text is in an encoding that is not read", "Save the file as UTF-8."],
  unsupported: ["This form of mesh is not read", "Export it with plain faces."],
  bad_header: ["The beginning of the file contradicts itself", EXPORT_AGAIN],
  bad_data: ["The file contradicts itself", EXPORT_AGAIN],
  bad_number: [
    "A number cannot be read",
    "Decimals need a point, not a comma: look at the export's settings for language.",
  ],
  truncated: ["The file was cut short", "Copy or export it again, then add it anew."],
  trailing_data: ["The file goes on after its end", EXPORT_AGAIN],
  index_out_of_range: ["A face names a point that is not there", EXPORT_AGAIN],
  non_finite: ["A position is no number", "Repair the mesh in the program that it comes from."],
  no_faces: ["There is no surface", "Make faces of the points first, in the program that it comes from."],
  zero_area: ["Nothing is left of the surface", "Look at the scale of the mesh: all its faces are without extent."],
  missing_texture: [
    "A file is missing",
    "Choose the file or drop it here; or go on without the texture.", "file", "untextured",
  ],
  unsafe_reference: [
    "A file lies somewhere else",
    "Choose the file or drop it here; or go on without it.", "file", "untextured",
  ],
  bad_image: [
    "A texture cannot be read as an image",
    "Save it as PNG or JPEG under the same name, and add it here.", "file",
  ],
  image_too_large: ["A texture is too large", "Make the image smaller, keep its name, and add it here.", "file"],
  bad_archive: [
    "The zip cannot be read",
    "Pack it anew, without a password and without zips inside; or add the files themselves.",
  ],
  archive_too_large: ["The zip holds too much", "Add the files themselves, or pack less."],
  too_complex: ["The mesh is too complex", SIMPLIFY],
  unsolved: ["The mesh could not be described with certainty", "Repair or simplify the mesh, then add it again."],
  gave_up: ["The mesh could not be described", `It needed more memory or time than there is. ${SIMPLIFY}`, "again"],
  unexpected: ["Something went wrong with this mesh", TELL, "again"],
  internal_error: ["Something went wrong in the service", TELL, "again"],
  body_too_large: [
    "This is more than the service takes at once",
    "Make the textures smaller or simplify the mesh; or ask whoever runs the service for more.",
  ],
  too_many_files: ["These are more files than one shape may have", "Pack the mesh and its files into a zip."],
  field_too_long: ["A name is too long", "Give the file a shorter name."],
  slow_body: ["It came too slowly", "Try again over a better connection.", "again"],
  incomplete_body: ["The connection broke", "Try again over a better connection.", "again"],
  broken_connection: [
    "The connection broke again and again",
    "It may be larger than what the service, or something in between, lets through. Try again, or make it smaller.", "again",
  ],
  file_gone: ["A file cannot be read any more", "Choose it again from where it is now."],
  no_vocabulary: [
    "The library cannot compare shapes yet",
    "Whoever runs the service makes it ready with “faience learn-vocabulary”.", "again",
  ],
  // what concerns every upload, and stops them all
  unauthorised: ["The library needs a key", "Enter it, then go on."],
  read_only_key: ["This key may look, not add", "Enter a key that may change the library, then go on."],
  foreign_host: ["The library is open to its own machine only", "Ask whoever runs the service for a key."],
  cross_origin: ["This page may not add to the library", "Open the page at the service's own address."],
  storage_full: [
    "The disk is full",
    "Nothing is lost here. Remove shapes, or ask whoever runs the service for space; then go on.",
  ],
  // what passes by itself
  too_many_uploads: ["As many as this key may send in a minute", "It goes on by itself."],
  unreachable: ["The service does not answer", "It goes on by itself as soon as the service is back."],
  stopping: ["The service is being restarted", "It goes on by itself."],
  storage_unreachable: ["The service cannot reach its files", "It goes on by itself."],
  keys_unreadable: ["The service cannot read its keys", "It goes on by itself."],
};
const BUSY = ["The service is busy", "It goes on by itself."];
const OTHER = ["This is refused", "Try again; if it is refused again, tell whoever runs the service.", "again"];

/**
 * Put a refusal into words.
 *
 * @param {{code: string, status: number}} problem
 * @returns {{title: string, action: string, remedies: string[]}}
 */
export function inWords({ code, status }) {
  const passes = [429, 502, 503, 504].includes(status);
  const [title, action, ...remedies] = Object.hasOwn(REFUSALS, code) ? REFUSALS[code] : passes ? BUSY : OTHER;
  return { title, action, remedies };
}

/** What can be done about a refused upload; nothing can be put into a zip from here. */
export function remediesOf({ mesh, problem }) {
  const { remedies } = inWords(problem);
  return kindOf(mesh.path) === "zip" ? remedies.filter((remedy) => remedy !== "file") : remedies;
}

/** What to do about it. */
export function actionOf({ mesh, problem }) {
  const zipped = kindOf(mesh.path) === "zip" && inWords(problem).remedies.includes("file");
  return zipped ? "Put the file into the zip and add it again." : inWords(problem).action;
}
