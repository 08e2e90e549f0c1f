// Which shapes stand together once pairs were dismissed or shapes removed: as service/relations/grouping.py decides it.

const CLOSEST = ["same_file", "same_shape", "recoloured", "re_posed", "part_of", "similar"];

/** Name a pair, whichever of the two comes first. */
export const keyOf = (one, other) => (one < other ? `${one} ${other}` : `${other} ${one}`);

/**
 * Divide a group as the service gave it into what is left of it.
 *
 * @param {{shapes: object[], evidence: {one: string, other: string, relation: {name: string}}[]}} group
 * @param {Set<string>} dismissed - keys of pairs
 * @param {Set<string>} removed - ids of shapes
 * @returns {{id: string, relation: string, shapes: object[], evidence: object[]}[]} none holds both of a dismissed pair
 */
export function leftOf(group, dismissed, removed) {
  const pairs = group.evidence.filter(({ one, other }) =>
    !dismissed.has(keyOf(one, other)) && !removed.has(one) && !removed.has(other));
  const left = [];
  let uncovered = pairs;
  while (uncovered.length) {
    const members = grown(uncovered[0], pairs, dismissed);
    const inside = (pair) => members.has(pair.one) && members.has(pair.other);
    left.push(part(group, members, pairs.filter(inside)));
    uncovered = uncovered.filter((pair) => !inside(pair));
  }
  return left;
}

/** Join to a pair whatever is joined to one of them and dismissed with none, until nothing is. */
function grown(seed, pairs, dismissed) {
  const members = new Set([seed.one, seed.other]);
  for (;;) {
    const joined = pairs.flatMap(({ one, other }) => [[one, other], [other, one]])
      .filter(([near, far]) => members.has(near) && !members.has(far)).map(([, far]) => far).sort();
    const fits = (far) => [...members].every((member) => !dismissed.has(keyOf(far, member)));
    const found = joined.find(fits);
    if (found === undefined) return members;
    members.add(found);
  }
}

function part(group, members, evidence) {
  const names = evidence.map(({ relation }) => relation.name);
  return {
    id: [...members].sort().join(" "),
    relation: CLOSEST.findLast((name) => names.includes(name)), // the loosest that joins two of them
    shapes: group.shapes.filter((shape) => members.has(shape.id)),
    evidence,
  };
}
