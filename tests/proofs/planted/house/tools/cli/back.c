/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/planted_scene.h"
