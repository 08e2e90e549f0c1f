// The numbers by which a relation is told, in words. The limits are those of service/relations/deciding.py.

export const LIMITS = { shape: 0.065, colour: 0.035, pattern: 0.45, pose: 0.35, fits: 2, bent: 3, part: 1.3 };

const short = (number) => number.toLocaleString("en-GB", { maximumSignificantDigits: 2 });
const said = (number) => (number > 0 && number < 0.01 ? "less than 0.01" : short(number));
const percent = (share) => `${said(100 * share)}%`;
const centimetres = (length) => `${said(length)} cm`;

/**
 * Say what speaks for a relation, one sentence or two for each number.
 *
 * @param {{name: string, shape_distance: number, colour_distance: number, pattern_distance: number,
 *   pose_distance: number?, misfit: number?, part: string?}} relation
 * @returns {string[]}
 */
export function evidenceOf(relation) {
  if (relation.name === "same_file") return ["Both were sent with the same mesh file, and nothing that is compared differs."];
  const told = [shape(relation), colours(relation), places(relation)];
  if (relation.pose_distance !== null) told.push(pose(relation));
  if (relation.misfit !== null) told.push(relation.part ? cut(relation) : misfit(relation));
  return relation.pose_distance === null && relation.misfit === null ? told : [...told, UNIT];
}

const UNIT = "Centimetres count on the shapes made as large as a person, with a surface of 1.9 m².";

const shape = ({ shape_distance: share }) =>
  `Shape: ${percent(share)} of the surface is formed otherwise, however it is bent. Up to ${percent(LIMITS.shape)} counts as the same shape.`;

const colours = ({ colour_distance: share }) =>
  `Colours: ${percent(share)} of the surface has colours that the other lacks. Up to ${percent(LIMITS.colour)} counts as the same colours.`;

const places = ({ pattern_distance: share }) =>
  `Where the colours are: a difference of ${percent(share)}; 100% is unrelated. Up to ${percent(LIMITS.pattern)} counts as the same places.`;

const pose = ({ pose_distance: length }) =>
  `Pose: points lie nearer or further apart by ${centimetres(length)} on average. From ${centimetres(LIMITS.pose)} on it counts as another pose.`;

const misfit = ({ misfit: length }) =>
  `Laid on each other, the two lie at most ${centimetres(length)} apart, the worst twentieth left out. ` +
  `Up to ${centimetres(LIMITS.fits)} counts as the same pose, from ${centimetres(LIMITS.bent)} on as another.`;

const cut = ({ misfit: length }) =>
  `The smaller one lies within ${centimetres(length)} of the larger one. Up to ${centimetres(LIMITS.part)} counts as cut from it.`;
