// Tags: what `metadata.tags` holds. A single text counts as one; compared without regard to capitals.

/** Fold a text as the service does, near enough: ß and SS are alike. */
export const folded = (text) => text.toUpperCase().toLowerCase();

const written = (value) => [value].flat().filter((one) => typeof one === "string").map((one) => one.trim());

/** The tags of a shape, each as it was first written. */
export function tagsOf({ metadata }) {
  const found = new Map();
  for (const tag of written(metadata.tags)) if (tag && !found.has(folded(tag))) found.set(folded(tag), tag);
  return [...found.values()];
}

export const hasTag = (shape, tag) => tagsOf(shape).some((one) => folded(one) === folded(tag.trim()));

/** Metadata with one more tag; all else stays. */
export function withTag(metadata, tag) {
  if (hasTag({ metadata }, tag)) return metadata;
  return { ...metadata, tags: [...[metadata.tags ?? []].flat(), tag.trim()] };
}

/** Metadata without a tag, however it is written; all else stays, also what is among the tags and is no text. */
export function withoutTag(metadata, tag) {
  const is = (one) => typeof one === "string" && folded(one.trim()) === folded(tag.trim());
  const { tags, ...others } = metadata;
  const kept = [tags ?? []].flat().filter((one) => !is(one));
  return kept.length ? { ...others, tags: kept } : others;
}
