#include "cli/planted_cli.h"
