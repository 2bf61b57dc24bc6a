#include "import/raw_depth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bytes.h"
#include "file_bytes.h"
#include "reason.h"

int raw_depth_read(const char *path, const raw_depth *raw, picture *out, char *error, size_t error_bytes)
{
    const size_t count = (size_t)raw->width * raw->height;
    size_t there;
    uint8_t *bytes = t3r_file_bytes(path, count * 4, &there, error, error_bytes);
    if (bytes == NULL) {
        return -1;
    }
    uint16_t *samples = malloc(count * sizeof *samples);
    int status = there == count * 4 && samples != NULL
                     ? 0
                     : t3r_reason(error, error_bytes, "%s: %s", path,
                                  samples == NULL ? "out of memory" : "fewer bytes than its sides need");
    for (size_t i = 0; i < count && status == 0; i++) {
        const uint32_t bits = t3r_load_le32(bytes + 4 * i);
        float value;
        memcpy(&value, &bits, sizeof value);
        const double steps = nearbyint((double)value / raw->unit);
        samples[i] = steps >= 1 && steps <= UINT16_MAX ? (uint16_t)steps : 0;
    }
    free(bytes);
    if (status != 0) {
        free(samples);
        return -1;
    }
    *out = (picture){.width = raw->width, .height = raw->height, .channels = 1, .bits = 16, .samples = samples};
    return 0;
}
