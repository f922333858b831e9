"""A small dense network with one output, its Jacobian and its gradient, written out."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from pin_metaik.arguments import array, checked
from pin_metaik.arrays import Array
from pin_metaik.errors import InvalidSetting
from pin_metaik.randomness import as_generator

ROWS = 4096  # at a time: as many stay in the cache, and BLAS does not spread them over threads that wait for each other

WIDEST = 10_000  # neurons of a layer: this is a small dense network


@checked
@dataclass(frozen=True)
class Network:
    """Layers of tanh neurons and one linear output; ``Network(2, (5, 5))`` is 2:5:5:1.

    All its weights are one vector w: for each layer its matrix (outputs, inputs) row by row, then its biases.

    Attributes:
        inputs: Number of inputs.
        hidden: Neurons of each hidden layer.

    Raises:
        InvalidSetting: A layer without neurons.
    """

    inputs: int
    hidden: tuple[int, ...]

    def __post_init__(self) -> None:
        if not all(1 <= neurons <= WIDEST for neurons in (self.inputs, *self.hidden)):
            raise InvalidSetting(f"every layer has 1 to {WIDEST:,} neurons, got {self}")

    @property
    def sizes(self) -> tuple[int, ...]:
        """Neurons of every layer, inputs and output included."""
        return (self.inputs, *self.hidden, 1)

    @cached_property
    def count(self) -> int:
        """Number of weights, biases included."""
        return sum(out * (into + 1) for into, out in zip(self.sizes[:-1], self.sizes[1:], strict=True))

    def initial(self, rng: int | np.random.Generator | None) -> Array:
        """Random weights (count,) after Nguyen and Widrow 1990, for inputs in [-1, 1].

        The neurons of a hidden layer divide the range of its inputs among them; the output starts near zero.
        """
        generator = as_generator(rng)
        parts: list[Array] = []
        for into, out in zip(self.sizes[:-2], self.sizes[1:-1], strict=True):
            beta = 0.7 * out ** (1 / into)
            W = generator.uniform(-1, 1, (out, into))
            W *= beta / np.linalg.norm(W, axis=1, keepdims=True)
            spread = np.linspace(-beta, beta, out) if out > 1 else np.zeros(1)
            parts += [W.ravel(), spread * np.sign(W[:, 0])]
        parts.append(generator.uniform(-0.5, 0.5, self.sizes[-2] + 1) / math.sqrt(self.sizes[-2]))
        return np.concatenate(parts)

    def outputs(self, w: Array, X: Array) -> Array:
        """Outputs (n,) for inputs X (n, inputs)."""
        w, X = self._given(w, X)
        pieces = (X[first : first + ROWS] for first in range(0, len(X) or 1, ROWS))
        return np.concatenate([self._forward(w, piece)[-1][:, 0] for piece in pieces])

    def jacobian(self, w: Array, X: Array) -> Array:
        """Derivatives (n, count) of the outputs by the weights."""
        w, X = self._given(w, X)
        activations = self._forward(w, X)
        J = np.empty((len(X), self.count))
        for weights, biases, a, delta in self._backward(w, activations, np.ones((len(X), 1))):
            J[:, biases] = delta
            shape = delta.shape[1], a.shape[1]
            np.multiply(delta[:, :, None], a[:, None, :], out=J[:, weights].reshape(len(X), *shape))
        return J

    def gradient(self, w: Array, X: Array, y: Array) -> tuple[float, Array]:
        """Mean squared error of the outputs against y (n,), and its gradient (count,)."""
        w, X = self._given(w, X)
        activations = self._forward(w, X)
        error = activations[-1] - array("y", y, len(X), finite=False)[:, None]
        gradient = np.empty(self.count)
        for weights, biases, a, delta in self._backward(w, activations, 2 / max(len(X), 1) * error):
            gradient[biases] = delta.sum(axis=0)
            gradient[weights] = (delta.T @ a).ravel()
        return float(np.mean(np.square(error))), gradient

    def _backward(
        self, w: Array, activations: list[Array], delta: Array
    ) -> Iterator[tuple[slice, slice, Array, Array]]:
        """Backpropagation, from the last layer to the first.

        Yields where the weights and the biases of a layer are in w, its inputs (n, into), and the derivatives
        (n, neurons) by the sums in its neurons; ``delta`` are those of the last layer.
        """
        end = self.count
        for layer, (W, _) in reversed(list(enumerate(self._layers(w)))):
            a, middle, start = activations[layer], end - len(W), end - len(W) - W.size
            yield slice(start, middle), slice(middle, end), a, delta
            end = start
            if layer:
                delta = (delta @ W) * (1 - a**2)

    def _given(self, w: Array, X: Array) -> tuple[Array, Array]:
        """Weights (count,) and inputs (n, inputs) of a caller, checked."""
        return array("w", w, self.count, finite=False), array("X", X, "n", self.inputs, finite=False)

    def _layers(self, w: Array) -> list[tuple[Array, Array]]:
        """Matrix and biases of every layer, as views of w."""
        layers, at = [], 0
        for into, out in zip(self.sizes[:-1], self.sizes[1:], strict=True):
            W = w[at : at + into * out].reshape(out, into)
            layers.append((W, w[at + into * out : at + (into + 1) * out]))
            at += (into + 1) * out
        return layers

    def _forward(self, w: Array, X: Array) -> list[Array]:
        """What every layer hands on (n, neurons), the inputs first and the output last."""
        layers = self._layers(w)
        activations = [X]
        for W, b in layers[:-1]:
            activations.append(np.tanh(activations[-1] @ W.T + b))
        W, b = layers[-1]
        activations.append(activations[-1] @ W.T + b)
        return activations

    def __str__(self) -> str:
        return ":".join(map(str, self.sizes))
