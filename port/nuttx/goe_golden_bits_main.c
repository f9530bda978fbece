/* Replays the embedded logs through the estimator and through the flight layer, and prints a hash of every output bit:
 * the same as on every other target, or goe_self_check() gives the reason. SPDX-License-Identifier: MIT */
int goe_replay_main(void);
int goe_flight_main(void);

int main(void) {
    (void)goe_replay_main();
    (void)goe_flight_main();
    return 0;
}
