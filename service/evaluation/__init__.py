"""How well the methods find shapes that were bent, cut or recoloured: the paper's protocol, its report."""
