// What can be changed about a shape. Each returns the shape as it is then.

import { path, read, request } from "../shared/api.js";
import { withTag, withoutTag } from "../shared/tags.js";

const at = ({ id }, ...more) => path(["shapes", id, ...more]);

export const rename = (shape, name) => read(at(shape), { method: "PATCH", json: { name } });
export const retry = (shape) => read(at(shape, "retry"), { method: "POST" });
export const remove = (shape) => request(at(shape), { method: "DELETE" });
export const addTag = (shape, tag) => changeMetadata(shape, (metadata) => withTag(metadata, tag));
export const removeTag = (shape, tag) => changeMetadata(shape, (metadata) => withoutTag(metadata, tag));

/** The service replaces all metadata: begin with what it has now, since others may have changed it. */
async function changeMetadata(shape, change) {
  const { metadata } = await read(at(shape));
  return read(at(shape), { method: "PATCH", json: { metadata: change(metadata) } });
}
