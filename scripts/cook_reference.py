#!/usr/bin/python3
"""Reference of launch/scenes/reference/cook.yaml by mixed finite elements: cook_reference.py POISSON_RATIO CELLS...

Hexahedra with quadratic displacements (27 nodes) and a linear pressure of their own (Q2/P1: no volumetric locking), half of the panel,
neo-Hookean with the energy mu/2 (I1 - 3) - mu ln J + p ln J - p^2 / (2 lambda), dead shear in steps, Newton's method with a direct solver.
One mesh per number of CELLS along the sides (a quarter of it through half of the thickness); prints the deflection of the corner on
each, its extrapolation, and the entry of references.yaml. Needs python3-scipy.
"""
import sys

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg as linalg

LENGTH, HALF_THICKNESS, MODULUS, TRACTION = 0.048, 0.005, 1e5, 3000.0


def height(x):
    """Lower and upper edge of the panel at x."""
    share = x / LENGTH
    return 0.044 * share, 0.044 + 0.016 * share


def quadratic(s):
    """Values and derivatives of the three quadratic polynomials through -1, 0, 1."""
    return (np.array([0.5 * s * (s - 1), 1 - s * s, 0.5 * s * (s + 1)]), np.array([s - 0.5, -2 * s, s + 0.5]))


def shape(r, s, t):
    """27 values and their derivatives (27, 3)."""
    a, b, c = quadratic(r), quadratic(s), quadratic(t)
    values = np.einsum('i,j,k->ijk', a[0], b[0], c[0]).ravel()
    return values, np.stack([np.einsum('i,j,k->ijk', a[1], b[0], c[0]).ravel(), np.einsum('i,j,k->ijk', a[0], b[1], c[0]).ravel(),
                             np.einsum('i,j,k->ijk', a[0], b[0], c[1]).ravel()], axis=1)


class Panel:
    def __init__(self, cells, ratio):
        self.mu, self.lam = MODULUS / (2 * (1 + ratio)), MODULUS * ratio / ((1 + ratio) * (1 - 2 * ratio))
        self.n = (cells, max(1, cells // 4), cells)
        count = [2 * n + 1 for n in self.n]
        x, y, z = np.meshgrid(*(np.linspace(0, 1, c) for c in count), indexing='ij')
        low, high = height(LENGTH * x)
        self.X = np.stack([LENGTH * x, HALF_THICKNESS * y, low + (high - low) * z], axis=-1).reshape(-1, 3)
        index = np.arange(len(self.X)).reshape(count)
        self.elements = np.array([index[2 * i:2 * i + 3, 2 * j:2 * j + 3, 2 * k:2 * k + 3].ravel()
                                  for i in range(self.n[0]) for j in range(self.n[1]) for k in range(self.n[2])])
        self.index = index
        held = np.zeros(self.X.shape, bool)
        held[index[0].ravel()] = True
        held[index[:, -1].ravel(), 1] = True  # plane of symmetry
        self.free = np.flatnonzero(~held.ravel())
        self.gauss = [(g, w) for g, w in zip(*np.polynomial.legendre.leggauss(3))]
        self.load = self.shear()
        self.u = np.zeros_like(self.X)
        self.p = np.zeros((len(self.elements), 4))

    def shear(self):
        """Nodal forces of a unit shear stress on the right face."""
        force = np.zeros_like(self.X)
        area = HALF_THICKNESS / self.n[1] * 0.016 / self.n[2]
        weight = np.array([1, 4, 1]) / 6
        for j in range(self.n[1]):
            for k in range(self.n[2]):
                face = self.index[-1, 2 * j:2 * j + 3, 2 * k:2 * k + 3]
                force[face.ravel(), 2] += (area * np.outer(weight, weight)).ravel()
        return force

    def assemble(self):
        """Residual and tangent without the load, pressures eliminated; keeps what gives their increment."""
        E = len(self.elements)
        K, R = np.zeros((E, 81, 81)), np.zeros((E, 81))
        G, H, C = np.zeros((E, 81, 4)), np.zeros((E, 4)), np.zeros((E, 4, 4))
        X, x = self.X[self.elements], (self.X + self.u)[self.elements]
        for r, wr in self.gauss:
            for s, ws in self.gauss:
                for t, wt in self.gauss:
                    _, d = shape(r, s, t)
                    jacobian = np.einsum('eni,na->eia', X, d)
                    w = wr * ws * wt * np.linalg.det(jacobian)
                    g = np.einsum('na,eai->eni', d, np.linalg.inv(jacobian))
                    F = np.einsum('eni,enj->eij', x, g)
                    J, inverse = np.linalg.det(F), np.linalg.inv(F)
                    q = np.array([1, r, s, t])
                    p = self.p @ q
                    it = inverse.transpose(0, 2, 1)  # F^-T
                    P = self.mu * F + (p - self.mu)[:, None, None] * it
                    # d(F^-T)_ij / dF_kl = - F^-1_jk F^-1_li
                    A = -(p - self.mu)[:, None, None, None, None] * np.einsum('ejk,eli->eijkl', inverse, inverse)
                    A += self.mu * np.einsum('ik,jl->ijkl', np.eye(3), np.eye(3))
                    R += np.einsum('e,eij,enj->eni', w, P, g).reshape(E, 81)
                    Ag = np.einsum('e,eijkl,enj->enikl', w, A, g).reshape(E, 81, 3, 3)
                    K += np.einsum('eakl,eml->eamk', Ag, g, optimize=True).reshape(E, 81, 81)
                    b = np.einsum('eij,enj->eni', it, g).reshape(E, 81)
                    G += np.einsum('e,ea,q->eaq', w, b, q)
                    H += np.einsum('e,q->eq', w * (np.log(J) - p / self.lam), q)
                    C += np.einsum('e,q,r->eqr', w, q, q) / self.lam
        self.G, self.H, self.C = G, H, C
        Ci = np.linalg.inv(C)
        K += np.einsum('eaq,eqr,ebr->eab', G, Ci, G, optimize=True)
        R += np.einsum('eaq,eqr,er->ea', G, Ci, H)
        dofs = (3 * self.elements[:, :, None] + np.arange(3)).reshape(E, 81)
        rows, columns = np.repeat(dofs, 81, axis=1).ravel(), np.tile(dofs, (1, 81)).ravel()
        size = self.X.size
        tangent = sparse.csc_matrix((K.ravel(), (rows, columns)), shape=(size, size))
        residual = np.zeros(size)
        np.add.at(residual, dofs.ravel(), R.ravel())
        return residual, tangent, dofs

    def solve(self, steps=4):
        for step in range(1, steps + 1):
            for iteration in range(20):
                residual, tangent, dofs = self.assemble()
                out = (TRACTION * step / steps * self.load).ravel() - residual
                du = np.zeros(self.X.size)
                du[self.free] = linalg.splu(tangent[self.free][:, self.free], permc_spec='MMD_AT_PLUS_A').solve(out[self.free])
                self.p += np.einsum('eqr,er->eq', np.linalg.inv(self.C), self.H + np.einsum('eaq,ea->eq', self.G, du[dofs]))
                self.u += du.reshape(self.u.shape)
                if np.abs(du).max() < 1e-10 * LENGTH:
                    break
            else:
                sys.exit('Newton did not converge')
        return self.u

    def at(self, point):
        """Displacement at a point of the panel, mirrored where it lies in the other half."""
        X = np.array(point, float)
        mirrored = X[1] > HALF_THICKNESS
        if mirrored:
            X[1] = 2 * HALF_THICKNESS - X[1]
        low, high = height(X[0])
        share = np.array([X[0] / LENGTH, X[1] / HALF_THICKNESS, (X[2] - low) / (high - low)]) * self.n
        cell = np.minimum(share.astype(int), np.array(self.n) - 1)
        values, _ = shape(*(2 * (share - cell) - 1))
        nodes = self.index[tuple(slice(2 * c, 2 * c + 3) for c in cell)].ravel()
        u = values @ self.u[nodes]
        return u * [1, -1, 1] if mirrored else u


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    ratio, levels = float(sys.argv[1]), [int(n) for n in sys.argv[2:]]
    deflection = []
    for cells in levels:
        panel = Panel(cells, ratio)
        panel.solve()
        deflection.append(panel.at([LENGTH, HALF_THICKNESS, 0.06])[2])
        print(f'# {cells} cells, {panel.X.size} unknowns: corner {1000 * deflection[-1]:.5f} mm', flush=True)
    value = deflection[-1]
    if len(levels) > 2:  # error in proportion to h^order
        a, b, c = deflection[-3:]
        order = np.log((b - a) / (c - b)) / np.log(levels[-1] / levels[-2]) if (b - a) / (c - b) > 1 else 1
        value = c + (c - b) / ((levels[-1] / levels[-2]) ** order - 1)
        print(f'# order about {order:.2f}; extrapolated {1000 * value:.5f} mm')
    generator = np.random.default_rng(1)
    points = [[x, y, low + (high - low) * z] for x, y, z in generator.uniform(0.04, 0.96, (32, 3)) * [LENGTH, 2 * HALF_THICKNESS, 1]
              for low, high in [height(x)]]
    write = lambda rows: '[' + ', '.join('[' + ', '.join(f'{v:.6g}' for v in row) + ']' for row in rows) + ']'  # noqa: E731
    print(f'cook_1e+05_{ratio:g}_neo_hookean:\n  value: {value:.7g}')
    print('  points: ' + write(points))
    print('  displacements: ' + write(panel.at(point) for point in points))


if __name__ == '__main__':
    main()
