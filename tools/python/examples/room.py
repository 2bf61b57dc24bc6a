# SPDX-License-Identifier: Apache-2.0
# %% [markdown]
# # A room at several budgets
#
# Two frames of a built-in room become scenes of 2 to 100 % of their points. A third frame, which no scene was given,
# shows how good they are. The cells run one after the other in any editor that knows `# %%`, or all at once as a script.

# %%
import matplotlib.pyplot as plt
import numpy as np

import trim3r

frames = trim3r.room()
context, held_out = [frames[0], frames[2]], frames[1]
print(f"trim3r {trim3r.__version__}: {len(frames)} frames of {held_out.size[0]}x{held_out.size[1]}")

# %% [markdown]
# ## The sweep
#
# One analysis serves all budgets. The figures are those of `trim3r eval`.

# %%
rows = trim3r.evaluate(context, held_out, keep=[2, 5, 10, 20, 40, 100])
for row in rows:
    print(f"{row.keep:5} % {row.gaussians:7} Gaussians {row.psnr:6.2f} dB  SSIM {row.ssim:.3f}")

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
axes.semilogx([row.gaussians for row in rows], [row.psnr for row in rows], "o-", label="held-out view")
axes.semilogx([row.gaussians for row in rows], [row.context_psnr for row in rows], "s--", label="context views")
axes.set(xlabel="Gaussians", ylabel="PSNR in dB", title="Quality against budget")
axes.grid(alpha=0.3)
axes.legend()
figure.savefig("budgets.png", dpi=120)

# %% [markdown]
# ## One scene by hand
#
# The runtime takes the frames where they lie, and a scene is a view of its arena. So what is cheap in C is cheap here.

# %%
room = trim3r.Reconstructor(256, 256, views=2, head="small")
for frame in context:
    room.add_view(frame)
scene = room.build(keep=10)
print(f"{len(scene)} of {scene.valid_points} points, an arena of {room.arena_bytes / 1e6:.1f} MB")
print("the hash of the build:", trim3r.run_hash(room.stage_hashes))
print("from", scene.positions.min(axis=0).round(2), "to", scene.positions.max(axis=0).round(2), "metres")

# %% [markdown]
# ## Where the scene is wrong
#
# Colour, depth and error of the view that was held out.

# %%
assert held_out.camera is not None and isinstance(held_out.colour, np.ndarray) and held_out.depth is not None
picture = room.picture(held_out.camera)
difference = np.abs(picture.colour.astype(int) - held_out.colour).mean(axis=2)
panels = {"recorded": held_out.colour, "drawn": picture.colour, "depth in metres": picture.depth,
          "difference": difference}

figure, places = plt.subplots(1, len(panels), figsize=(12, 3.4), layout="constrained")
for place, (name, panel) in zip(places, panels.items()):
    place.imshow(panel)
    place.set(title=name, xticks=[], yticks=[])
figure.savefig("views.png", dpi=120)

# %% [markdown]
# ## A camera of one's own, and a file
#
# Poses are camera-to-world. This one stands 20 cm to the right of the held-out one.

# %%
pose = held_out.camera.pose
pose[:3, 3] += 0.2 * pose[:3, 0]
aside = room.render(held_out.camera.at(pose))
print(f"20 cm aside: {aside.shape[1]}x{aside.shape[0]} pixels, {100 * (aside.any(axis=2)).mean():.0f} % of them drawn")
scene.save("room.ply")
room.close()
