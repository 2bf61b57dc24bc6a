/* SPDX-License-Identifier: Apache-2.0 */
/* The camera's descriptors, sent when it is plugged in: USB 2.0, 9.5 and 9.6; UVC 1.0, chapter 3. */
#ifndef T3R_TESTS_USB_DESCRIPTORS_H
#define T3R_TESTS_USB_DESCRIPTORS_H

#include <stdint.h>

#define DESCRIPTOR_MOST_BYTES 256u

/* Writes a descriptor by its type (USB_DT_DEVICE, USB_DT_CONFIG or USB_DT_STRING) and index to
 * out[DESCRIPTOR_MOST_BYTES]; returns its bytes, 0 if there is none. */
uint32_t descriptor_get(uint8_t type, uint8_t index, uint8_t *out);

#endif
