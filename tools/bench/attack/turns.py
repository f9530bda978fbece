"""Rotation matrices (..., 3, 3) and Hamilton quaternions (..., 4) in the order w, x, y, z."""

from __future__ import annotations

import numpy as np

CAMERA_TO_BODY = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])  # unmounted: along body x


def about(axis: int, angle: np.ndarray | float) -> np.ndarray:
    """Turns about an axis by angles in rad."""
    angle = np.asarray(angle, float)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.zeros((*angle.shape, 3, 3))
    matrix[..., axis, axis] = 1.0
    matrix[..., i, i] = matrix[..., j, j] = np.cos(angle)
    matrix[..., j, i] = np.sin(angle)
    matrix[..., i, j] = -matrix[..., j, i]
    return matrix


def of_angles(yaw: np.ndarray | float, pitch: np.ndarray | float, roll: np.ndarray | float) -> np.ndarray:
    """Rotations about z, then the new y, then the newest x."""
    return about(2, yaw) @ about(1, pitch) @ about(0, roll)


def angles_of(matrix: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Yaw, pitch and roll of ``of_angles``; pitch within 90 degrees."""
    yaw = np.arctan2(matrix[..., 1, 0], matrix[..., 0, 0])
    pitch = -np.arcsin(np.clip(matrix[..., 2, 0], -1.0, 1.0))
    return yaw, pitch, np.arctan2(matrix[..., 2, 1], matrix[..., 2, 2])


def of_vector(vector: np.ndarray) -> np.ndarray:
    """Rotations by vectors (..., 3) in rad: I + sin(a)/a K + (1 - cos(a))/a^2 K K."""
    size = np.linalg.norm(vector, axis=-1)[..., None, None]
    x, y, z = np.moveaxis(vector, -1, 0)
    none = np.zeros_like(x)
    cross = np.stack([np.stack(r, -1) for r in ((none, -z, y), (z, none, -x), (-y, x, none))], -2)
    return np.eye(3) + np.sinc(size / np.pi) * cross + 0.5 * np.sinc(0.5 * size / np.pi) ** 2 * cross @ cross


def quaternion(matrix: np.ndarray) -> np.ndarray:
    """Quaternions of rotation matrices: the row of q q' with the largest diagonal (Bar-Itzhack's symmetric matrix
    without the search for eigenvectors), w >= 0."""
    m = np.asarray(matrix, float)
    d = [m[..., i, i] for i in range(3)]
    products = np.empty((*m.shape[:-2], 4, 4))  # 4 q q'
    products[..., 0, 0] = 1 + d[0] + d[1] + d[2]
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        products[..., i + 1, i + 1] = 1 + d[i] - d[j] - d[k]
        products[..., 0, i + 1] = products[..., i + 1, 0] = m[..., k, j] - m[..., j, k]
        products[..., i + 1, j + 1] = products[..., j + 1, i + 1] = m[..., j, i] + m[..., i, j]
    best = np.argmax(np.einsum("...ii->...i", products), -1)
    q = np.take_along_axis(products, best[..., None, None], -2)[..., 0, :]
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    return np.where(q[..., :1] < 0, -q, q)
