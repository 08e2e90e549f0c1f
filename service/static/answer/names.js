// Methods and what they look at, as people would call them. The service's own names stay beside them.

const METHODS = {
  chks: "The paper's main system",
  hks: "The paper's geometry alone",
  diffusion: "How far heat travels: geometry alone",
  "colour-diffusion": "How far heat travels over shape and colours",
  "colour-histogram": "Which colours, wherever they are",
  meshhog: "Edges of colour around striking points",
};

const BLOCKS = {
  "log-hks": "shape",
  "colour-histogram": "colours",
  "colour-curves": "where the colours are",
  "hks-0": "shape",
  "hks-0.05": "shape with some colour",
  "hks-0.1": "shape with more colour",
};

export const methodTitle = ({ name }) => (METHODS[name] ? `${METHODS[name]} (${name})` : name);

export const blockTitle = (name) => BLOCKS[name] ?? name;
