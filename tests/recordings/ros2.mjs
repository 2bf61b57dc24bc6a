/* SPDX-License-Identifier: Apache-2.0 */
// ROS 2's messages as a ROS 2 installation defines them: definitions with all that they refer to, and as text.
import common from "@foxglove/rosmsg-msgs-common";

const known = common.ros2humble;

// The message first, then what it refers to.
export function definitions(name) {
  const short = name.replace("/msg/", "/"), found = new Map([[short, known[short]]]);
  for (const definition of found.values()) { // grows while it is walked
    for (const { isComplex, type } of definition.definitions) {
      if (isComplex) found.set(type, known[type]);
    }
  }
  return [...found.values()];
}

const field = ({ type, name, isArray, arrayLength }) =>
  `${type === "time" ? "builtin_interfaces/Time" : type}${isArray ? `[${arrayLength ?? ""}]` : ""} ${name}`;

export function text(name) {
  return definitions(name).map((definition, i) => {
    const head = i === 0 ? "" : `${"=".repeat(80)}\nMSG: ${definition.name}\n`;
    return head + definition.definitions.filter((f) => !f.isConstant).map(field).join("\n");
  }).join("\n");
}
