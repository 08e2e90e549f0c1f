"""How well the methods find shapes that were bent, cut and recoloured: the paper's protocol and its report."""
