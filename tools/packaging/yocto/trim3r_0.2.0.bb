# SPDX-License-Identifier: Apache-2.0
# The recipe for Yocto: the tree itself is built, wherever this file lies in it.
SUMMARY = "Posed camera frames to a budgeted set of 3-D Gaussians, in integers"
LICENSE = "Apache-2.0"
LIC_FILES_CHKSUM = "file://LICENSE;md5=3b83ef96387f14655fc854ddc3c6bd57"

inherit cmake pkgconfig externalsrc

EXTERNALSRC ?= "${THISDIR}/../../.."

PACKAGECONFIG ??= "comparison stereo streams learned refinement extras backdrop"
PACKAGECONFIG[comparison] = "-DT3R_WITH_COMPARISON=ON,-DT3R_WITH_COMPARISON=OFF"
PACKAGECONFIG[stereo] = "-DT3R_WITH_STEREO=ON,-DT3R_WITH_STEREO=OFF"
PACKAGECONFIG[streams] = "-DT3R_WITH_STREAMS=ON,-DT3R_WITH_STREAMS=OFF"
PACKAGECONFIG[learned] = "-DT3R_WITH_LEARNED=ON,-DT3R_WITH_LEARNED=OFF"
PACKAGECONFIG[refinement] = "-DT3R_WITH_REFINEMENT=ON,-DT3R_WITH_REFINEMENT=OFF"
PACKAGECONFIG[extras] = "-DT3R_WITH_EXTRAS=ON,-DT3R_WITH_EXTRAS=OFF"
PACKAGECONFIG[backdrop] = "-DT3R_WITH_BACKDROP=ON,-DT3R_WITH_BACKDROP=OFF"

FILES:${PN} += "${datadir}/sbom"

EXTRA_OECMAKE = "-DT3R_TOOLS=OFF"
