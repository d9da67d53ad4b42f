//! Queues: agents join them at the end, move up, are served at the front and go on.

use super::Crowd;
use super::trips::stage_share;
use crate::journeys::{Kind, Queue, Status};
use crate::math::Vector;
use crate::scene::Scene;

/// Agents within this distance of the end of a queue join it, meters.
const JOINING: f64 = 1.0;

impl Crowd {
    /// Agent `i` walks to the end of a queue, and joins it there.
    pub(super) fn approach(&mut self, scene: &Scene, i: usize, queue: &Queue) {
        let position = self.agents.position[i];
        let Some(trip) = &mut self.agents.trip[i] else {
            return;
        };
        let place = trip.place;
        let state = &mut self.progress.places[usize::from(place)];
        let waiting = state.tickets.saturating_sub(state.passed) as usize;
        let end = queue.spot(waiting);
        if (end - position).norm() <= JOINING.max(queue.spacing) {
            trip.status = Status::Queued {
                ticket: state.tickets,
                since: self.clock.frame(),
                until: None,
            };
            trip.chooses_at = u64::MAX;
            state.tickets += 1;
            state.longest = state.longest.max(waiting as u32 + 1);
            trip.hold = Some(end);
            self.agents.goal[i] = end;
            return;
        }
        // Straight to the end of the queue if no wall stands between; otherwise along its path.
        let sees = |p: Vector| {
            let near = scene.walls.near_any(&[position, p], 0.0);
            scene.walls.first_crossing(position, p, &near).is_none()
        };
        let near = |p: &&Vector| (*p - position).norm() <= JOINING;
        trip.hold = if sees(end) {
            Some(end)
        } else {
            let here = queue.path.iter().position(|p| near(&p));
            here.map(|k| queue.path[queue.next_corner(k, waiting)])
        };
    }

    /// Agents in queues move up, are served and go on.
    pub(super) fn serve_queues(&mut self, scene: &Scene) {
        let trips = self.agents.trip.iter().enumerate();
        let queued = trips.filter_map(|(i, trip)| {
            let trip = trip.as_ref()?;
            let Status::Queued { ticket, .. } = trip.status else {
                return None;
            };
            Some((trip.place, ticket, i))
        });
        let mut queued: Vec<(u16, u32, usize)> = queued.collect();
        queued.sort_unstable();
        for one_queue in queued.chunk_by(|a, b| a.0 == b.0) {
            let place = &scene.journeys.places[usize::from(one_queue[0].0)];
            if let Kind::Queue(queue) = &place.kind {
                for (ahead, &(.., i)) in one_queue.iter().enumerate() {
                    self.serve(scene, queue, ahead, i);
                }
            }
        }
    }

    /// Moves agent `i`, which has `ahead` agents before it, up in its queue, and serves it at the front.
    fn serve(&mut self, scene: &Scene, queue: &Queue, ahead: usize, i: usize) {
        let (id, position) = (self.agents.id[i], self.agents.position[i]);
        let Some(trip) = &mut self.agents.trip[i] else {
            return;
        };
        let Status::Queued {
            ticket,
            since,
            until,
        } = trip.status
        else {
            return;
        };
        let spot = queue.spot(ahead);
        trip.hold = Some(spot);
        self.agents.goal[i] = spot;
        let is_there = (position - spot).norm() <= JOINING;
        let until = match until {
            None if ahead < queue.servers as usize && is_there => {
                let lasting = queue.service.quantile(stage_share(scene, id, trip));
                Some(self.clock.coarse_frame_at(self.clock.time() + lasting))
            }
            until => until,
        };
        trip.status = Status::Queued {
            ticket,
            since,
            until,
        };
        if until.is_some_and(|until| until <= self.clock.frame()) {
            self.count_wait(i, since);
            self.go_on(scene, i);
        }
    }
}
