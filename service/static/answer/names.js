// Methods, as people would call them. The service's own name stays beside them.

const METHODS = {
  chks: "The paper's main system",
  hks: "The paper's geometry alone",
  diffusion: "How far heat travels: geometry alone",
  "colour-diffusion": "How far heat travels over shape and colours",
  "colour-histogram": "Which colours, wherever they are",
  meshhog: "Edges of colour around striking points",
};

export const methodTitle = ({ name }) => (METHODS[name] ? `${METHODS[name]} (${name})` : name);
