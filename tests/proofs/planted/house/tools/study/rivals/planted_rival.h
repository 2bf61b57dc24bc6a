#include "scene/planted_scene.h"
