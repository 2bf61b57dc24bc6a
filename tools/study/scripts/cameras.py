# SPDX-License-Identifier: Apache-2.0
"""Cameras as matrices, and pictures compared: what tools/study/scripts/colours computes without the program."""
import cv2
import numpy as np

FLIP = np.diag([1.0, -1, -1, 1])  # OpenGL's camera axes and ours
SIDE, DISPARITIES = 256, 128


def matrix(rotation, position):
    w, x, y, z = np.array(rotation) / np.linalg.norm(rotation)
    m = np.eye(4)
    m[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                 [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                 [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]
    m[:3, 3] = position
    return m


def turned(a, b):
    """Returns the degrees between two rotations."""
    return np.degrees(2 * np.arcsin(min(1, np.linalg.norm(a[:3, :3] - b[:3, :3]) / np.sqrt(8))))


def pointed(a, b):
    """Returns the degrees between two translations."""
    a, b = a[:3, 3], b[:3, 3]
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b))


def nearest_rotation(matrix_3x3):
    u, _, vt = np.linalg.svd(matrix_3x3)
    return u @ np.diag([1, 1, np.linalg.det(u @ vt)]) @ vt


def laid_over(given, estimated, metric):
    """Returns the similarity from the given world to the estimated one: a matrix whose rotation is scaled."""
    centres = [[p[:3, 3] for p in poses] for poses in (given, estimated)]
    turn = nearest_rotation(sum(e[:3, :3] @ g[:3, :3].T for g, e in zip(given, estimated)))
    apart = [np.linalg.norm(second - first) for first, second in centres]
    out = np.eye(4)
    out[:3, :3] = turn * (1 if metric else apart[1] / apart[0])
    middle = [np.mean(c, 0) for c in centres]
    out[:3, 3] = middle[1] - out[:3, :3] @ middle[0]
    return out


def psnr(a, b, mask):
    error = np.mean((a[mask].astype(float) - b[mask]) ** 2)
    return float(10 * np.log10(255**2 / max(error, 1e-9)))


# --- depth by OpenCV ---------------------------------------------------------------------------------------------------


def matcher():
    return cv2.StereoSGBM_create(0, DISPARITIES, 5, 8 * 25, 32 * 25, disp12MaxDiff=1, uniquenessRatio=10,
                                 speckleWindowSize=64, speckleRange=1, preFilterCap=63,
                                 mode=cv2.STEREO_SGBM_MODE_HH)


def rectified_depth(pictures, cameras):
    """Returns the depth of the first view by StereoSGBM, 0 = none; None where the pair cannot be rectified."""
    (k, pose), (k2, pose2) = cameras
    relative = np.linalg.inv(pose2) @ pose
    baseline = pose[:3, :3].T @ (pose2[:3, 3] - pose[:3, 3])
    ahead = abs(baseline[2]) / np.linalg.norm(baseline)
    if ahead > 0.7:
        return None
    try:
        r1, r2, p1, p2, *_ = cv2.stereoRectify(k, None, k2, None, (SIDE, SIDE), relative[:3, :3], relative[:3, 3],
                                               flags=cv2.CALIB_ZERO_DISPARITY, alpha=-1)
    except cv2.error:
        return None
    maps = [cv2.initUndistortRectifyMap(m, None, r, p, (SIDE, SIDE), cv2.CV_32FC1)
            for m, r, p in ((k, r1, p1), (k2, r2, p2))]
    flat = [cv2.remap(cv2.cvtColor(p, cv2.COLOR_BGR2GRAY), *m, cv2.INTER_LINEAR) for p, m in zip(pictures, maps)]
    upright = abs(p2[1, 3]) > abs(p2[0, 3])
    shift = p2[1, 3] if upright else p2[0, 3]  # - focal length x baseline, when the second is to the right
    flat = [p.T.copy() if upright else p for p in flat]
    if shift > 0:
        flat = [p[:, ::-1].copy() for p in flat]
    wide = [cv2.copyMakeBorder(p, 0, 0, DISPARITIES, 0, cv2.BORDER_CONSTANT) for p in flat]
    disparity = matcher().compute(*wide)[:, DISPARITIES:] / 16.0
    disparity = disparity[:, ::-1] if shift > 0 else disparity
    disparity = disparity.T if upright else disparity
    z = np.where(disparity > 0.25, abs(shift) / np.maximum(disparity, 0.25), 0)
    # back to the view's own pixels
    y, x = np.mgrid[:SIDE, :SIDE]
    rays = np.linalg.inv(k) @ np.stack([x.ravel(), y.ravel(), np.ones(SIDE * SIDE)])
    ahead_rays = p1[:, :3] @ r1 @ rays
    with np.errstate(divide="ignore", invalid="ignore"):
        u, v = ahead_rays[0] / ahead_rays[2], ahead_rays[1] / ahead_rays[2]
    inside = (ahead_rays[2] > 0) & (u > -0.5) & (v > -0.5) & (u < SIDE - 0.5) & (v < SIDE - 0.5)
    column, row = np.where(inside, np.rint(u), 0).astype(int), np.where(inside, np.rint(v), 0).astype(int)
    ahead_of = (r1 @ rays)[2]  # z of the ahead_rays ray while z of the view's own grows by 1
    depth = np.where(inside, z[row, column] / np.maximum(ahead_of, 1e-6), 0).reshape(SIDE, SIDE)
    return depth


def spread(values, there):
    """Returns the values, and where there is none that of the nearest pixel."""
    _, labels = cv2.distanceTransformWithLabels((~there).astype(np.uint8), cv2.DIST_L2, 5, labelType=cv2.DIST_LABEL_PIXEL)
    known = np.zeros((labels.max() + 1, *values.shape[2:]), values.dtype)
    known[labels[there]] = values[there]
    return known[labels]


def filled(depth):
    return spread(depth, depth > 0) if (depth > 0).any() else depth


def moved(picture, depth, camera, target):
    """Returns the pixels of a view where the target sees them, the nearest first, and between them those next to them."""
    (k, pose), (k2, pose2) = camera, target
    y, x = np.mgrid[:SIDE, :SIDE]
    points = np.linalg.inv(k) @ np.stack([x.ravel(), y.ravel(), np.ones(SIDE * SIDE)]) * depth.ravel()
    seen = np.linalg.inv(pose2) @ pose @ np.vstack([points, np.ones(SIDE * SIDE)])
    ahead = (seen[2] > 1e-6) & (depth.ravel() > 0)
    at = k2 @ seen[:3]
    u, v = (np.where(ahead, np.rint(at[i] / np.where(ahead, at[2], 1)), -1) for i in (0, 1))
    ok = np.nonzero(ahead & (u >= 0) & (v >= 0) & (u < SIDE) & (v < SIDE))[0]
    ok = ok[np.argsort(-seen[2][ok], kind="stable")]
    out, hit = np.zeros_like(picture), np.zeros((SIDE, SIDE), bool)
    out[v[ok].astype(int), u[ok].astype(int)] = picture.reshape(-1, 3)[ok]
    hit[v[ok].astype(int), u[ok].astype(int)] = True
    return spread(out, hit)
