// Which relations to look for, as the address says it.

export const KINDS = ["same_file", "same_shape", "recoloured", "re_posed"];
export const USUAL = ["same_file", "same_shape", "recoloured"];

/** What a group is, by the loosest relation that joins two of it. */
export const GROUPS = {
  same_file: "the same file",
  same_shape: "the same shape, exported or meshed anew",
  recoloured: "the same shape in other colours",
  re_posed: "the same shape in another pose",
};

/** Read them out of an address's parameters; without any, the usual ones. */
export function kindsOf(query) {
  const asked = query.getAll("relation");
  const known = KINDS.filter((kind) => asked.includes(kind));
  return known.length ? known : USUAL;
}

/** Write the address of a choice. */
export function addressOf(kinds) {
  if (USUAL.length === kinds.length && USUAL.every((kind) => kinds.includes(kind))) return "#/duplicates";
  return `#/duplicates?${new URLSearchParams(kinds.map((kind) => ["relation", kind]))}`;
}
